"""Measure how far from their moments the requests of a 100 Hz stream are sent: alone, and not.

The arm is a trivial responder in another process, on a pty. A slot without a sample counts as late
by a whole period. The first row is a bare `time.sleep` until each moment: it shows how late the
machine is by itself.

Python lets a busy thread run for 5 ms (its switch interval) before another one gets its turn. A
sample needs two turns: to send the request, and to take the reply. So beside a busy thread a stream
of 100 Hz has a sample in every second slot, unless the interval is shorter: the rows with 1 ms.
"""

from __future__ import annotations

import argparse
import asyncio
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

from client import RESPONDER
from cobotwire.editions.mycobot280 import AsyncMyCobot280, GetAngles, MyCobot280
from cobotwire.session.sample import Sample, StreamReport
from responder import responder, within

RATE = 100.0
QUIET_LIMIT, BUSY_LIMIT = 0.001, 0.006
SHORT_INTERVAL = 0.001


class Run(NamedTuple):
    """How far from its moment each request was sent, in seconds; and the report."""

    off: list[float]
    report: StreamReport


def main() -> None:
    """Measure and print; with --strict, exit with 1 if a limit is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=8.0, help="the length of each run")
    parser.add_argument("--strict", action="store_true", help="exit with 1 if a limit is missed")
    options = parser.parse_args()
    count = int(options.seconds * RATE)
    clients: dict[str, Callable[[str, int], Run]] = {
        "blocking": _blocking,
        "asyncio": lambda url, count: asyncio.run(_asyncio(url, count)),
    }
    _show_times("sleep, alone", _sleeps(count))
    met = True
    with responder(RESPONDER) as url:
        for name, run in clients.items():
            met &= _show(f"{name}, alone", run(url, count), QUIET_LIMIT)
            with _busy_thread():
                met &= _show(f"{name}, busy", run(url, count), BUSY_LIMIT)
            with _busy_thread(), _switch_interval(SHORT_INTERVAL):
                met &= _show(f"{name}, busy, 1 ms", run(url, count), BUSY_LIMIT)
    sys.exit(1 if options.strict and not met else 0)


def _show(name: str, run: Run, limit: float) -> bool:
    missed = run.report.slots - run.report.samples
    off = run.off + [1 / RATE] * missed
    met = _percentile(off) <= limit
    verdict = f"{within(met)} {limit * 1e3:.0f} ms"
    _show_times(name, off, f"{verdict}   {missed} of {run.report.slots} slots missed")
    return met


def _show_times(name: str, late: list[float], more: str = "") -> None:
    half, p99 = _percentile(late, 50) * 1e3, _percentile(late) * 1e3
    print(f"{RATE:.0f} Hz, {name:20} off by {half:5.2f} ms (median), {p99:5.2f} ms (99 %)   {more}")


def _percentile(values: list[float], percent: int = 99) -> float:
    ordered = sorted(values)
    return ordered[len(ordered) * percent // 100]


@contextmanager
def _busy_thread() -> Iterator[None]:
    ended = False

    def work() -> None:
        while not ended:
            sum(range(1000))

    thread = threading.Thread(target=work)
    thread.start()
    try:
        yield
    finally:
        ended = True
        thread.join()


@contextmanager
def _switch_interval(seconds: float) -> Iterator[None]:
    usual = sys.getswitchinterval()
    sys.setswitchinterval(seconds)
    try:
        yield
    finally:
        sys.setswitchinterval(usual)


def _sleeps(count: int) -> list[float]:
    started = time.monotonic()
    late = []
    for slot in range(1, count):
        moment = started + slot / RATE
        time.sleep(max(0.0, moment - time.monotonic()))
        late.append(time.monotonic() - moment)
    return late


def _blocking(url: str, count: int) -> Run:
    with MyCobot280(url) as arm, arm.stream(GetAngles(), rate=RATE) as stream:
        started = time.monotonic()
        off = []
        for sample in stream:
            off.append(_off(started, sample))
            if sample.slot >= count:
                break
        return Run(off, stream.report)


async def _asyncio(url: str, count: int) -> Run:
    async with AsyncMyCobot280(url) as arm, arm.stream(GetAngles(), rate=RATE) as stream:
        started = time.monotonic()
        off = []
        async for sample in stream:
            off.append(_off(started, sample))
            if sample.slot >= count:
                break
        return Run(off, stream.report)


def _off(started: float, sample: Sample) -> float:
    """Return how far from its moment a sample was requested; slot 0 is when the stream started."""
    return abs(sample.readings[0].requested_at - started - sample.slot / RATE)


if __name__ == "__main__":
    main()
