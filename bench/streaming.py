"""A day of a stream at 100 Hz in accelerated time: memory flat, none twice, none out of order.

    python bench/streaming.py              about a minute of this machine's time
    python bench/streaming.py --whole-day  all of the day's 8.64 million slots

The line is in memory and owns the clock (tests/accelerated.py); the driver, the session and the
native codec are those of every call. Some answers are lost, some slow, some come too late.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from accelerated import Checker, accelerated

RATE = 100.0
DAY = 86_400.0
MINUTE = 50.0
# What a process may grow between a tenth of the run and its end, in bytes: a page here and there.
GROWTH = 1 << 20
CHUNK = 1000


def main() -> None:
    """Stream for a minute of ours, or a day of the arm's; print what came and what it took."""
    bound = None if "--whole-day" in sys.argv[1:] else MINUTE
    started = time.perf_counter()
    early: int | None = None
    with accelerated(RATE) as (arm, stream):
        checker = Checker(arm)
        share = spent = 0.0
        begun = arm.now
        while share < 1.0 and (bound is None or spent < bound):
            for _ in range(CHUNK):
                sample = next(stream)
                reading = sample.readings[0]
                checker.check(
                    sample.number, sample.slot, reading.value, reading.asked_at, reading.answered_at
                )
            share = (arm.now - begun) / DAY
            spent = time.perf_counter() - started
            if early is None and (share if bound is None else spent / bound) >= 0.1:
                early = _resident()
        report = stream.report
    assert early is not None, "a tenth comes before the end"
    grown = _resident() - early
    slots = round((arm.now - begun) * RATE)
    assert abs(report.slots - slots) <= 1, "every slot is a sample, or missed and counted"
    print(
        f"a day at {RATE:.0f} Hz: {share:.1%} of it in {spent:.0f} s, {DAY * share / spent:.0f} x "
        f"real time; none twice, none out of order"
    )
    print(f"  {report}; {spent / report.samples * 1e6:.0f} us a sample")
    print(
        f"  memory at 10 % {early / 1e6:.2f} MB, at the end {grown / 1e3:+.0f} kB   "
        f"{'within' if grown <= GROWTH else 'OVER'} {GROWTH / 1e3:.0f} kB"
    )


def _resident() -> int:
    """Bytes of this process that are in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


if __name__ == "__main__":
    main()
