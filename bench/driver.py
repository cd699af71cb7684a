"""How fast a call is: over a pty, against a trivial responder in a process of its own.

The floor is what the machine needs for the same bytes: os.write, select, os.read. All candidates
take turns on one and the same responder in one run. Each counts by its fastest turn, since what
else runs on the machine only adds to the others; what is held to limits is the ratio.

The simulated arm answers on a pty of its own, asked by the same bare calls: its row says how much
longer than the trivial responder it takes.

A pty has no baud rate, so "the time that the bytes need" is that of the fastest line there is: ten
bits a byte at 1,000,000 baud. Beside it stands what bare os.write takes for the same frames.
"""

from __future__ import annotations

import asyncio
import os
import select
import subprocess
import sys
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot

QUESTION = bytes.fromhex("FE FE 02 20 FA")
ANSWER = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
RESPONDER = f"""
import os, sys
master = int(sys.argv[1])
while data := os.read(master, 4096):
    if data[3] == 0x20:
        os.write(master, {ANSWER!r})
"""
SIMULATED = """
from cobotwire.editions.mycobot import TABLE
from cobotwire.sim import PtyPort, SimulatedArm
port = PtyPort(SimulatedArm(TABLE))
print(port.url, flush=True)
port.serve()
"""
TURNS, CALLS, WARM_UP = 20, 50, 5
SETTERS = 1000
FASTEST_BAUD = 1_000_000
LIMITS = {"blocking": 2.0, "asyncio": 3.0, "of a simulated arm": 3.0}
TIMES_FASTER = 8.0


def main() -> None:
    """Measure, and print ratios beside the limits."""
    with _responder() as url, _simulated() as simulated:
        _round_trips(url, simulated)
    with _responder() as url:
        _setters(url)


@contextmanager
def _responder() -> Iterator[str]:
    master, slave = os.openpty()
    tty.setraw(slave)
    command = [sys.executable, "-c", RESPONDER, str(master)]
    with subprocess.Popen(command, pass_fds=[master]) as responder:  # noqa: S603  (our own)
        try:
            yield os.ttyname(slave)
        finally:
            responder.kill()
            os.close(master)
            os.close(slave)


@contextmanager
def _simulated() -> Iterator[str]:
    command = [sys.executable, "-c", SIMULATED]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as arm:  # noqa: S603  (our own)
        assert arm.stdout is not None
        try:
            yield arm.stdout.readline().strip()
        finally:
            arm.kill()


def _round_trips(url: str, simulated: str) -> None:
    """Each candidate opens the port for its turn, since a port is locked; opening is not timed."""
    candidates = {
        "floor": _floor,
        "of a simulated arm": lambda _: _floor(simulated),
        "blocking": _blocking,
        "asyncio": lambda port: asyncio.run(_asyncio(port)),
        "pymycobot": _pymycobot,
    }
    taken: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(TURNS):
        for name, turn in candidates.items():
            taken[name].append(turn(url) / CALLS)
    best = {name: min(times) for name, times in taken.items()}
    for name, seconds in best.items():
        ratio = seconds / best["floor"]
        limit = LIMITS.get(name)
        verdict = "" if limit is None else f"   {_within(ratio <= limit)} {limit:.0f} x"
        print(f"get_angles, {name:22} {seconds * 1e6:6.0f} us   {ratio:5.1f} x floor{verdict}")
    faster = best["pymycobot"] / best["blocking"]
    verdict = _within(faster >= TIMES_FASTER)
    print(
        f"{'than pymycobot, blocking':34} {faster:5.1f} x faster   {verdict} {TIMES_FASTER:.0f} x"
    )


def _within(right: bool) -> str:
    return "within" if right else "OVER"


def _timed(call: Callable[[], Any]) -> float:
    for _ in range(WARM_UP):
        call()
    started = time.perf_counter()
    for _ in range(CALLS):
        call()
    return time.perf_counter() - started


def _floor(url: str) -> float:
    descriptor = os.open(url, os.O_RDWR | os.O_NOCTTY)

    def call() -> None:
        os.write(descriptor, QUESTION)
        select.select([descriptor], [], [], 1.0)
        if len(os.read(descriptor, 4096)) != len(ANSWER):
            raise SystemExit("the responder answers in parts: nothing to measure here")

    try:
        return _timed(call)
    finally:
        os.close(descriptor)


def _blocking(url: str) -> float:
    with MyCobot(url) as arm:
        return _timed(arm.get_angles)


async def _asyncio(url: str) -> float:
    async with AsyncMyCobot(url) as arm:
        for _ in range(WARM_UP):
            await arm.get_angles()
        started = time.perf_counter()
        for _ in range(CALLS):
            await arm.get_angles()
        return time.perf_counter() - started


def _pymycobot(url: str) -> float:
    from pymycobot import MyCobot280 as Theirs

    arm = Theirs(url, "115200")
    try:
        return _timed(arm.get_angles)
    finally:
        arm._serial_port.close()


def _setters(url: str) -> None:
    """Setters that nothing answers; the responder reads them and keeps silent."""
    size = 0

    def orders(arm: MyCobot) -> float:
        started = time.perf_counter()
        for index in range(SETTERS):
            arm.set_color(index % 256, 2, 3)
        return time.perf_counter() - started

    with MyCobot(url) as arm:
        frames: list[bytes] = []
        end = arm.watch(lambda traffic: frames.append(traffic.data))
        arm.set_color(1, 2, 3)
        end()
        size = SETTERS * len(frames[0])
        ours = min(orders(arm) for _ in range(5))
    descriptor = os.open(url, os.O_RDWR | os.O_NOCTTY)
    started = time.perf_counter()
    for _ in range(SETTERS):
        os.write(descriptor, frames[0])
    bare = time.perf_counter() - started
    os.close(descriptor)
    line = size * 10 / FASTEST_BAUD
    print(
        f"{SETTERS} setters, unanswered {ours * 1e3:8.1f} ms   {ours / line:5.1f} x the line's "
        f"{line * 1e3:.0f} ms at 1 Mbaud   {_within(ours <= 2 * line)} 2 x   "
        f"({ours / bare:.1f} x bare os.write)"
    )


if __name__ == "__main__":
    main()
