"""Measure how much real time a client in stepped time needs, over a transport in memory."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import islice

from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock

TURNS = 5
MINUTE_AT_100_HZ = 6001


def main() -> None:
    """Measure both kinds of work; print the fastest run of each."""
    for name, work in (("a motion that is waited for", _move), ("a minute at 100 Hz", _stream)):
        stepped, real = min((_turn(work) for _ in range(TURNS)), key=lambda turn: turn[1])
        print(f"{name:30} {stepped:6.1f} s of the arm's time in {real * 1e3:6.1f} ms")


def _turn(work: Callable[[MyCobot280], object]) -> tuple[float, float]:
    clock = SteppedClock()
    arm = MyCobot280(MemoryTransport(SimulatedArm(TABLE, clock=clock), clock))
    arm.power_on()
    began, started = clock(), time.perf_counter()
    work(arm)
    return clock() - began, time.perf_counter() - started


def _move(arm: MyCobot280) -> None:
    arm.move_angles([74, 0, 0, 0, 0, 0], 5)


def _stream(arm: MyCobot280) -> None:
    list(islice(arm.stream(TABLE.request_type("get_angles")(), rate=100), MINUTE_AT_100_HZ))


if __name__ == "__main__":
    main()
