"""pymycobot, unmodified, runs a whole session over a pty and over TCP, with its own timeouts."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, RunningClock, Server, SimulatedArm, TcpServer

DONE = 1
ARM_SPEED = 4.0
POSE = [30.0, -20.0, -35.0, 25.0, 40.0, 15.0]
NEAR = [20.0, -25.0, -30.0, 20.0, 35.0, 10.0]
# Any result; and the coordinates that the session read at POSE, as an argument or a result.
ANY, READ = "any", "the coordinates read before"
# pymycobot waits 0.3 s (TCP) or 0.5 s if no reply arrives, and 15 s for a motion that never ends.
REPLY_SECONDS, MOTION_SECONDS = 0.28, 10.0


class Step(NamedTuple):
    """A call, its result, and a pause after it, in seconds of the arm's time.

    A step with ``tolerance`` returns a row of numbers near ``result``.
    """

    name: str
    values: tuple[Any, ...] = ()
    result: Any = DONE
    pause: float = 0.0
    tolerance: float = 0.0


SESSION = (
    Step("is_power_on", result=0),
    Step("power_on"),
    Step("is_power_on"),
    Step("sync_send_angles", (POSE, 60)),
    Step("get_angles", result=POSE, tolerance=0.1),
    Step("get_coords", result=ANY),
    Step("sync_send_angles", (NEAR, 60)),
    Step("sync_send_coords", (READ, 60, 0)),
    Step("get_coords", result=READ, tolerance=0.5),
    Step("send_angle", (1, 0, 80), pause=1.5),
    Step("jog_angle", (1, 1, 20), pause=0.5),
    Step("is_moving"),
    Step("stop", pause=0.5),  # the arm brakes
    Step("is_moving", result=0),
    Step("resume"),
    Step("jog_increment", (2, 10, 60), pause=1.0),
    Step("set_gripper_value", (60, 100), pause=2.0),
    Step("get_gripper_value", result=60),
    Step("set_digital_output", (23, 1)),
    Step("get_digital_input", (23,)),
    Step("set_basic_output", (5, 1)),
    Step("get_basic_input", (5,)),
    Step("set_color", (0, 128, 255)),
    Step("power_off"),
    Step("is_power_on", result=0),
)


def pymycobot_on(url: str) -> Any:
    """Open pymycobot's class for a port or a socket; both constructors sleep 1.5 s."""
    with warnings.catch_warnings():
        # Its import uses deprecated features of Python.
        warnings.simplefilter("ignore")
        from pymycobot import MyCobot280, MyCobot280Socket
    if not url.startswith("socket://"):
        return MyCobot280(url, "115200")
    host, _, port = url.removeprefix("socket://").rpartition(":")
    return MyCobot280Socket(host, int(port))


SERVERS: dict[str, Callable[[SimulatedArm, RunningClock], Server]] = {
    "pty": PtyServer,
    "TCP": lambda arm, clock: TcpServer(arm.connect, clock=clock),
}


@contextmanager
def session(transport: str) -> Iterator[tuple[Any, RunningClock]]:
    """Connect pymycobot to a new arm, in accelerated time."""
    clock = RunningClock(ARM_SPEED)
    with SERVERS[transport](SimulatedArm(TABLE, clock=clock), clock) as server:
        client = pymycobot_on(server.url)
        yield client, clock
        client.close()


@pytest.mark.parametrize("transport", SERVERS)
def test_each_call_returns_what_was_set_before_pymycobot_repeats_it(transport: str) -> None:
    coords: list[float] = []
    with session(transport) as (client, clock):
        for step in SESSION:
            values = [coords if value is READ else value for value in step.values]
            started = time.perf_counter()
            result = getattr(client, step.name)(*values)
            seconds = time.perf_counter() - started
            limit = MOTION_SECONDS if step.name.startswith("sync_") else REPLY_SECONDS
            assert seconds < limit, step
            wanted = coords if step.result is READ else step.result
            if wanted is ANY:
                coords = result
            elif step.tolerance:
                assert result == pytest.approx(wanted, abs=step.tolerance)
            else:
                assert result == wanted, step
            clock.sleep(step.pause)
