"""pymycobot, unmodified, runs a whole session over a pty and over TCP, with its own waiting."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any, NamedTuple

import pytest

from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import PtyServer, RunningClock, Server, SimulatedArm, TcpServer

DONE = 1
ARM_SPEED = 4.0
POSE = [30.0, -20.0, -35.0, 25.0, 40.0, 15.0]
NEAR = [20.0, -25.0, -30.0, 20.0, 35.0, 10.0]
# A placeholder for the coordinates that the session read at POSE.
READ = "the coordinates read before"


class Step(NamedTuple):
    """A call, by pymycobot's name, and a pause after it, in seconds of the arm's time."""

    name: str
    values: tuple[Any, ...] = ()
    pause: float = 0.0


SESSION = (
    Step("is_power_on"),
    Step("power_on"),
    Step("is_power_on"),
    Step("sync_send_angles", (POSE, 60)),
    Step("get_angles"),
    Step("get_coords"),
    Step("sync_send_angles", (NEAR, 60)),
    Step("sync_send_coords", (READ, 60, 0)),
    Step("get_angles"),
    Step("get_coords"),
    Step("send_angle", (1, 0, 80), 1.5),
    Step("jog_angle", (1, 1, 20), 0.5),
    Step("is_moving"),
    Step("stop", pause=0.5),  # the arm brakes
    Step("is_moving"),
    Step("resume"),
    Step("jog_increment", (2, 10, 60), 1.0),
    Step("get_angles"),
    Step("set_gripper_value", (60, 100), 2.0),
    Step("get_gripper_value"),
    Step("set_digital_output", (23, 1)),
    Step("get_digital_input", (23,)),
    Step("set_basic_output", (5, 1)),
    Step("get_basic_input", (5,)),
    Step("set_color", (0, 128, 255)),
    Step("power_off"),
    Step("is_power_on"),
)
OUR_NAMES = {"sync_send_angles": "move_angles", "sync_send_coords": "move_coords"}


class Called(NamedTuple):
    """What a call returned or raised, and the real seconds that it took."""

    result: Any
    seconds: float


def play(client: Any, clock: RunningClock) -> list[Called]:
    """Play the session; an exception is the result of its call."""
    called: list[Called] = []
    coords: Sequence[float] = ()
    for step in SESSION:
        name = step.name if hasattr(client, step.name) else OUR_NAMES[step.name]
        values = [coords if value is READ else value for value in step.values]
        started = time.perf_counter()
        try:
            result = getattr(client, name)(*values)
        except Exception as error:  # the table shows any exception
            result = error
        called.append(Called(result, time.perf_counter() - started))
        if step.name == "get_coords" and isinstance(result, list | tuple):
            coords = result
        clock.sleep(step.pause)
    return called


def pymycobot_on(url: str) -> Any:
    """Open pymycobot's class for a port or a socket; both constructors sleep 1.5 s."""
    with warnings.catch_warnings():
        # Its import uses deprecated features of Python.
        warnings.simplefilter("ignore")
        from pymycobot import MyCobot280 as Theirs
        from pymycobot import MyCobot280Socket as TheirSocket
    if not url.startswith("socket://"):
        return Theirs(url, "115200")
    host, _, port = url.removeprefix("socket://").rpartition(":")
    return TheirSocket(host, int(port))


CLIENTS: dict[str, Callable[[str], Any]] = {"pymycobot": pymycobot_on, "cobotwire": MyCobot280}
SERVERS: dict[str, Callable[[SimulatedArm, RunningClock], Server]] = {
    "pty": PtyServer,
    "TCP": lambda arm, clock: TcpServer(arm.connect, clock=clock),
}


@contextmanager
def session(who: str, transport: str) -> Iterator[tuple[Any, RunningClock]]:
    """Connect a client to a new arm."""
    clock = RunningClock(ARM_SPEED)
    with SERVERS[transport](SimulatedArm(TABLE, clock=clock), clock) as server:
        client = CLIENTS[who](server.url)
        try:
            yield client, clock
        finally:
            with suppress(OSError):
                client.close()


@pytest.fixture(scope="module", params=list(SERVERS))
def called(request: pytest.FixtureRequest) -> list[Called]:
    """Run one session on each kind of transport, in accelerated time."""
    with session("pymycobot", request.param) as (client, clock):
        return play(client, clock)


def results(called: list[Called], name: str) -> list[Any]:
    return [one.result for step, one in zip(SESSION, called) if step.name == name]


def test_every_setter_is_acknowledged_before_pymycobot_repeats_it(called: list[Called]) -> None:
    for step, one in zip(SESSION, called):
        if step.name.startswith(("set_", "send_", "sync_", "jog_", "power_", "stop", "resume")):
            assert one.result == DONE, step
        # pymycobot waits 0.3 s (TCP) or 0.5 s if no reply comes.
        assert step.name.startswith("sync_") or one.seconds < 0.28, step


def test_power_and_motion_read_back_as_they_were_set(called: list[Called]) -> None:
    assert results(called, "is_power_on") == [0, 1, 0]
    assert results(called, "is_moving") == [1, 0]


def test_synchronous_motion_ends_on_arrival_and_not_by_timeout(called: list[Called]) -> None:
    waited = [one.seconds for step, one in zip(SESSION, called) if step.name.startswith("sync_")]
    assert max(waited) < 10, "15 s is its timeout"
    there, back, jogged = results(called, "get_angles")
    assert there == pytest.approx(POSE, abs=0.1)
    assert jogged[1] != back[1]


def test_coordinates_read_back_as_they_were_sent(called: list[Called]) -> None:
    read, again = results(called, "get_coords")
    assert again == pytest.approx(read, abs=0.5)


def test_gripper_and_pins_read_back_as_they_were_set(called: list[Called]) -> None:
    assert results(called, "get_gripper_value") == [60]
    assert results(called, "get_digital_input") == [1]
    assert results(called, "get_basic_input") == [1]


def test_our_client_runs_the_same_session_without_an_error() -> None:
    with session("cobotwire", "TCP") as (client, clock):
        called = play(client, clock)
    assert not [one.result for one in called if isinstance(one.result, Exception)]
