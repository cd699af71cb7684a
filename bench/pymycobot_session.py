"""Time each call of a whole session: pymycobot 4.0.7, unmodified, and our client.

Each client drives its own simulated arm in real time, on a pty and over TCP. The output is a table.
A motion takes as long as the arm needs; the clients differ in what they add.
"""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any, NamedTuple

from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import PtyServer, RunningClock, Server, SimulatedArm, TcpServer

POSE = [30.0, -20.0, -35.0, 25.0, 40.0, 15.0]
# The fastest turn of each call counts, since other programs can only add time.
TURNS = 3
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
def session(who: str, transport: str, speed: float = 1.0) -> Iterator[tuple[Any, RunningClock]]:
    """Connect a client to a new arm."""
    clock = RunningClock(speed)
    with SERVERS[transport](SimulatedArm(TABLE, clock=clock), clock) as server:
        client = CLIENTS[who](server.url)
        try:
            yield client, clock
        finally:
            with suppress(OSError):
                client.close()


def main() -> None:
    """Measure and print."""
    columns: dict[str, list[Called]] = {}
    for _ in range(TURNS):
        for transport in SERVERS:
            for who in CLIENTS:
                with session(who, transport) as (client, clock):
                    called = play(client, clock)
                best = columns.setdefault(f"{who}, {transport}", called)
                columns[f"{who}, {transport}"] = [
                    min(pair, key=_seconds) for pair in zip(best, called)
                ]
    print("| call | " + " | ".join(columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for index, step in enumerate(SESSION):
        cells = [_cell(column[index]) for column in columns.values()]
        print(f"| `{step.name}` | " + " | ".join(cells) + " |")
    waits = [index for index, step in enumerate(SESSION) if step.name not in OUR_NAMES]
    sums = [sum(column[index].seconds for index in waits) for column in columns.values()]
    print(
        "| all calls except motions that were waited for | " + " | ".join(map(_time, sums)) + " |"
    )


def _seconds(called: Called) -> float:
    return called.seconds


def _cell(called: Called) -> str:
    return f"{_shown(called.result)} · {_time(called.seconds)}"


def _shown(result: Any) -> str:
    if isinstance(result, BaseException):
        return f"**{type(result).__name__}**"
    if isinstance(result, list | tuple):
        return " ".join(f"{part:g}" for part in result)
    return "-" if result is None else str(result)


def _time(seconds: float) -> str:
    digits = max(0, 1 - math.floor(math.log10(max(seconds * 1000, 1e-3))))
    return f"{seconds * 1000:.{digits}f} ms"


if __name__ == "__main__":
    main()
