"""Measure the time of a call over a pty, with a trivial responder in another process.

The floor is the time of bare system calls for the same bytes: os.write, select, os.read. Each call
is followed by these bare system calls on the same responder, so that both find caches and processor
in the same state. On some machines the time of the floor varies by a factor of four, which is more
than the time of the client. Candidates take turns. The fastest quarter of each candidate's turns
counts, since other programs on the machine can only add time. The limits apply to the median of
their ratios.

The simulated arm replies on its own pty to the same system calls. Its row shows how much longer it
takes than the trivial responder.

A pty has no baud rate. So the setters are compared with the fastest real line (ten bits a byte at
1,000,000 baud), and with bare os.write of the same frames.
"""

from __future__ import annotations

import asyncio
import os
import select
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from statistics import median

from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.pymycobot import MyCobot280 as Layer
from responder import responder, within

REQUEST = bytes.fromhex("FE FE 02 20 FA")
REPLY = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
RESPONDER = f"""
import os, sys
master = int(sys.argv[1])
while data := os.read(master, 4096):
    if data[3:4] == b"\x20":
        os.write(master, {REPLY!r})
"""
SIMULATED = """
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
port = PtyServer(SimulatedArm(TABLE))
print(port.url, flush=True)
port.serve()
"""
Call = Callable[[], object]
TURNS, CALLS, WARM_UP = 40, 50, 5
SETTERS = 1000
FASTEST_BAUD = 1_000_000
LIMITS = {"blocking": 1.35, "asyncio": 3.0, "simulated arm": 3.0}
# The limit of the blocking client applies from this floor on, in microseconds.
LEAST_FLOOR = 30.0
TIMES_FASTER = 5.0
# The layer with the maker's names against the client that it calls.
LAYER_LIMIT = 1.3


def main() -> None:
    """Measure, and print the ratios with their limits."""
    with responder(RESPONDER) as url, _simulated() as simulated:
        _round_trips(url, simulated)
    with responder(RESPONDER) as url:
        _setters(url)


@contextmanager
def _simulated() -> Iterator[str]:
    command = [sys.executable, "-c", SIMULATED]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as arm:
        assert arm.stdout is not None
        try:
            yield arm.stdout.readline().strip()
        finally:
            arm.kill()


@dataclass(frozen=True)
class Turn:
    """The mean seconds of a call, and of the bare system calls after it."""

    call: float
    floor: float

    @property
    def ratio(self) -> float:
        """How many times as long as the floor the call takes."""
        return self.call / self.floor


def _round_trips(url: str, simulated: str) -> None:
    """Time the candidates in turns; each opens the port, which locks it, only for its turn."""
    candidates: dict[str, Callable[[str, Call], Turn]] = {
        "simulated arm": lambda _, floor: _bare(simulated, floor),
        "blocking": _blocking,
        "blocking, of the 280": _of_the_280,
        "blocking, layer": _layer,
        "asyncio": lambda port, floor: asyncio.run(_asyncio(port, floor)),
        "pymycobot": _pymycobot,
    }
    turns: dict[str, list[Turn]] = {name: [] for name in candidates}
    with _exchange(url) as floor:
        for _ in range(TURNS):
            for name, turn in candidates.items():
                turns[name].append(turn(url, floor))
    fastest = {name: _fastest(own) for name, own in turns.items()}
    ratios = {name: median(turn.ratio for turn in own) for name, own in fastest.items()}
    for name, own in fastest.items():
        limit = LIMITS.get(name)
        verdict = "" if limit is None else f"   {within(ratios[name] <= limit)} {limit:g} x"
        call, bare = (median(getattr(turn, of) for turn in own) * 1e6 for of in ("call", "floor"))
        if name == "blocking" and bare < LEAST_FLOOR:
            verdict = (
                f"   {call - bare:.1f} us more; the limit is for a floor of {LEAST_FLOOR:g} us"
            )
        print(
            f"get_angles, {name:22} {call:6.1f} us   {ratios[name]:5.2f} x floor "
            f"({bare:.1f} us){verdict}"
        )
    faster = ratios["pymycobot"] / ratios["blocking"]
    verdict = within(faster >= TIMES_FASTER)
    name = "blocking, against pymycobot"
    print(f"{name:34} {faster:5.1f} x faster   {verdict} {TIMES_FASTER:.0f} x")
    share = ratios["blocking, layer"] / ratios["blocking, of the 280"]
    verdict = within(share <= LAYER_LIMIT)
    print(f"{'layer, against its client':34} {share:5.2f} x   {verdict} {LAYER_LIMIT} x")


def _fastest(turns: list[Turn]) -> list[Turn]:
    """Return the fastest quarter."""
    return sorted(turns, key=lambda turn: turn.call + turn.floor)[: len(turns) // 4]


def _timed(call: Call, floor: Call) -> Turn:
    for _ in range(WARM_UP):
        call()
        floor()
    own = bare = 0.0
    for _ in range(CALLS):
        started = time.perf_counter()
        call()
        between = time.perf_counter()
        floor()
        own, bare = own + between - started, bare + time.perf_counter() - between
    return Turn(own / CALLS, bare / CALLS)


@contextmanager
def _exchange(url: str) -> Iterator[Call]:
    """Open a port; yield a function that makes the system calls of one exchange."""
    descriptor = os.open(url, os.O_RDWR | os.O_NOCTTY)

    def call() -> None:
        os.write(descriptor, REQUEST)
        select.select([descriptor], [], [], 1.0)
        if len(os.read(descriptor, 4096)) != len(REPLY):
            raise SystemExit("the reply came in parts; run the bench again on a quiet machine")

    try:
        yield call
    finally:
        os.close(descriptor)


def _bare(url: str, floor: Call) -> Turn:
    with _exchange(url) as call:
        return _timed(call, floor)


def _blocking(url: str, floor: Call) -> Turn:
    with MyCobot(url) as arm:
        return _timed(arm.get_angles, floor)


def _of_the_280(url: str, floor: Call) -> Turn:
    with MyCobot280(url) as arm:
        return _timed(arm.get_angles, floor)


def _layer(url: str, floor: Call) -> Turn:
    arm = Layer(url, "115200")
    try:
        return _timed(arm.get_angles, floor)
    finally:
        arm.close()


async def _asyncio(url: str, floor: Call) -> Turn:
    async with AsyncMyCobot(url) as arm:
        for _ in range(WARM_UP):
            await arm.get_angles()
            floor()
        own = bare = 0.0
        for _ in range(CALLS):
            started = time.perf_counter()
            await arm.get_angles()
            between = time.perf_counter()
            floor()
            own, bare = own + between - started, bare + time.perf_counter() - between
        return Turn(own / CALLS, bare / CALLS)


def _pymycobot(url: str, floor: Call) -> Turn:
    from pymycobot import MyCobot280 as Theirs

    arm = Theirs(url, "115200")
    try:
        return _timed(arm.get_angles, floor)
    finally:
        arm._serial_port.close()


def _setters(url: str) -> None:
    """Time one-way setters; the responder reads them and sends nothing."""
    size = 0

    def setters(arm: MyCobot) -> float:
        started = time.perf_counter()
        for index in range(SETTERS):
            arm.set_color(index % 256, 2, 3)
        return time.perf_counter() - started

    with MyCobot(url) as arm:
        frames: list[bytes] = []
        end = arm.add_traffic_listener(lambda traffic: frames.append(traffic.data))
        arm.set_color(1, 2, 3)
        end()
        size = SETTERS * len(frames[0])
        ours = min(setters(arm) for _ in range(5))
    descriptor = os.open(url, os.O_RDWR | os.O_NOCTTY)
    started = time.perf_counter()
    for _ in range(SETTERS):
        os.write(descriptor, frames[0])
    bare = time.perf_counter() - started
    os.close(descriptor)
    line = size * 10 / FASTEST_BAUD
    print(
        f"{SETTERS} one-way setters    {ours * 1e3:8.1f} ms   {ours / line:5.1f} x the line's "
        f"{line * 1e3:.0f} ms at 1 Mbaud   {within(ours <= 2 * line)} 2 x   "
        f"({ours / bare:.1f} x bare os.write)"
    )


if __name__ == "__main__":
    main()
