"""Measure how late the samples of a 100 Hz stream are: alone, and beside a busy thread.

The arm is a trivial responder in another process, on a pty. For each sample there are two figures:
how far from its moment the request was written, and how late the consumer had the result. A slot
without a sample counts as late by a whole period.

A bare `time.sleep` until each moment takes turns with the streams. It shows how late the machine
and the interpreter are by themselves: no stream can be more punctual. Python lets a busy thread run
for 5 ms (its switch interval) before another one gets its turn.
"""

from __future__ import annotations

import argparse
import asyncio
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import NamedTuple

from client import RESPONDER
from cobotwire.editions.mycobot280 import AsyncMyCobot280, GetAngles, MyCobot280
from cobotwire.session.sample import Sample
from responder import responder, within

RATE = 100.0
QUIET_LIMIT, BUSY_LIMIT = 0.001, 0.006
ROUND_SECONDS = 2.0


class Punctuality(NamedTuple):
    """For each slot, in seconds, how far off the request was sent, and how late the result was."""

    off: list[float]
    late: list[float]


Measured = Callable[[str, int], Punctuality]


def main() -> None:
    """Measure and print; with --strict, exit with 1 if a limit is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=8.0, help="the length of each row")
    parser.add_argument("--strict", action="store_true", help="exit with 1 if a limit is missed")
    options = parser.parse_args()
    rounds = max(1, round(options.seconds / ROUND_SECONDS))
    measured: dict[str, Measured] = {
        "bare sleep": _sleeps,
        "blocking": _blocking,
        "asyncio": lambda url, count: asyncio.run(_asyncio(url, count)),
    }
    met = True
    with responder(RESPONDER) as url:
        for what, limit in (("alone", QUIET_LIMIT), ("busy", BUSY_LIMIT)):
            found = {name: Punctuality([], []) for name in measured}
            for _ in range(rounds):
                for name, measure in measured.items():
                    with _busy_thread() if what == "busy" else nullcontext():
                        run = measure(url, int(ROUND_SECONDS * RATE))
                    found[name].off.extend(run.off)
                    found[name].late.extend(run.late)
            for name, run in found.items():
                met &= _show(f"{name}, {what}", run, limit) or name == "bare sleep"
    sys.exit(1 if options.strict and not met else 0)


def _show(name: str, run: Punctuality, limit: float) -> bool:
    met = _percentile(run.late) <= limit
    missed = run.late.count(1 / RATE)
    print(
        f"{RATE:.0f} Hz, {name:17} sent {_both(run.off)} off, had {_both(run.late)} late "
        f"(median, 99 %)   {within(met)} {limit * 1e3:.0f} ms   {missed} of {len(run.late)} missed"
    )
    return met


def _both(values: list[float]) -> str:
    return f"{_percentile(values, 50) * 1e3:5.2f}, {_percentile(values) * 1e3:5.2f} ms"


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


def _sleeps(_: str, count: int) -> Punctuality:
    started = time.monotonic()
    late = []
    for slot in range(1, count):
        moment = started + slot / RATE
        time.sleep(max(0.0, moment - time.monotonic()))
        late.append(time.monotonic() - moment)
    return Punctuality(late, late)


def _blocking(url: str, count: int) -> Punctuality:
    with MyCobot280(url) as arm, arm.stream(GetAngles(), rate=RATE) as stream:
        started, found = time.monotonic(), Punctuality([], [])
        for sample in stream:
            if _note(found, started, sample) >= count:
                break
        return _with_missed(found, stream.report.missed)


async def _asyncio(url: str, count: int) -> Punctuality:
    async with AsyncMyCobot280(url) as arm, arm.stream(GetAngles(), rate=RATE) as stream:
        started, found = time.monotonic(), Punctuality([], [])
        async for sample in stream:
            if _note(found, started, sample) >= count:
                break
        return _with_missed(found, stream.report.missed)


def _note(found: Punctuality, started: float, sample: Sample) -> int:
    """Note a sample, and return its slot; slot 0 is when the stream started."""
    moment = started + sample.slot / RATE
    found.off.append(abs(sample.requested_at - moment))
    found.late.append(time.monotonic() - moment)
    return sample.slot


def _with_missed(found: Punctuality, missed: int) -> Punctuality:
    found.off.extend([1 / RATE] * missed)
    found.late.extend([1 / RATE] * missed)
    return found


if __name__ == "__main__":
    main()
