"""Measure how late the samples of a stream are: 100 Hz alone, 50 Hz beside a busy thread.

The arm is a trivial responder in another process, on a pty. For each sample there are two figures:
how far from the beginning of its period the request was written, and how late the consumer had the
result. A period without a sample counts as late by a whole period.

A bare `time.sleep` until each of these times takes turns with the streams. It shows how late the
machine and the interpreter are without a client: no stream can be more punctual. Python lets a busy
thread run for 5 ms (its switch interval) before another one gets its turn.
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

# At 100 Hz beside a busy thread, a stream would miss about every second period.
QUIET_RATE, BUSY_RATE = 100.0, 50.0
# The most that 99 % of the samples may be late, in seconds; the largest share of missed periods.
QUIET_LIMIT, BUSY_LIMIT = 0.0015, 0.01
ROUND_SECONDS = 2.0


class Punctuality(NamedTuple):
    """For each sample, in seconds, how far off it was sent and how late the result was.

    ``missed`` is the number of periods without a sample.
    """

    off: list[float]
    late: list[float]
    missed: int = 0


Measured = Callable[[str, float], Punctuality]


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
        "asyncio": lambda url, rate: asyncio.run(_asyncio(url, rate)),
    }
    met = True
    with responder(RESPONDER) as url:
        for busy, rate in ((False, QUIET_RATE), (True, BUSY_RATE)):
            found = {name: Punctuality([], []) for name in measured}
            for _ in range(rounds):
                for name, measure in measured.items():
                    with _busy_thread() if busy else nullcontext():
                        run, known = measure(url, rate), found[name]
                    found[name] = Punctuality(
                        known.off + run.off, known.late + run.late, known.missed + run.missed
                    )
            for name, run in found.items():
                met &= _show(name, rate, run, busy) or name == "bare sleep"
    sys.exit(1 if options.strict and not met else 0)


def _show(name: str, rate: float, run: Punctuality, busy: bool) -> bool:
    periods = len(run.late) + run.missed
    if busy:
        met, limit = run.missed <= BUSY_LIMIT * periods, f"{BUSY_LIMIT:.0%} missed"
    else:
        met, limit = _percentile(run.late) <= QUIET_LIMIT, f"{QUIET_LIMIT * 1e3:g} ms at 99 %"
    print(
        f"{rate:.0f} Hz, {name + (', busy' if busy else ', alone'):17} "
        f"sent {_both(run.off)} off, received {_both(run.late)} late (median, 99 %), "
        f"{run.missed} of {periods} missed   {within(met)} {limit}"
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


def _sleeps(_: str, rate: float) -> Punctuality:
    started = time.monotonic()
    late = []
    for period in range(1, int(ROUND_SECONDS * rate)):
        due = started + period / rate
        time.sleep(max(0.0, due - time.monotonic()))
        late.append(time.monotonic() - due)
    return Punctuality(late, late)


def _blocking(url: str, rate: float) -> Punctuality:
    with MyCobot280(url) as arm, arm.stream(GetAngles(), rate=rate) as stream:
        started, found = time.monotonic(), Punctuality([], [])
        for sample in stream:
            if _note(found, started, sample, rate) >= ROUND_SECONDS * rate:
                break
        return found._replace(missed=stream.report.missed)


async def _asyncio(url: str, rate: float) -> Punctuality:
    async with AsyncMyCobot280(url) as arm, arm.stream(GetAngles(), rate=rate) as stream:
        started, found = time.monotonic(), Punctuality([], [])
        async for sample in stream:
            if _note(found, started, sample, rate) >= ROUND_SECONDS * rate:
                break
        return found._replace(missed=stream.report.missed)


def _note(found: Punctuality, started: float, sample: Sample, rate: float) -> int:
    """Note a sample, and return its period; period 0 is when the stream started."""
    due = started + sample.period / rate
    found.off.append(abs(sample.requested_at - due))
    found.late.append(time.monotonic() - due)
    return sample.period


if __name__ == "__main__":
    main()
