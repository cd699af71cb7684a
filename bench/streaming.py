"""Stream for a day at 100 Hz in accelerated time; check memory, repetition and order.

    python bench/streaming.py              run for about a minute of real time
    python bench/streaming.py --whole-day  run all of the day's 8.64 million periods

The transport is in memory and owns the clock (tests/accelerated.py); client, session and native
codec are the ordinary ones. Some replies are lost, some are slow, and some exceed their deadline.
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
# How many bytes the process may grow after the first tenth of the run: some pages.
GROWTH = 1 << 20
CHUNK = 1000


def main() -> None:
    """Stream for a minute of real time, or for a day of the arm's time; print samples and cost."""
    bound = None if "--whole-day" in sys.argv[1:] else MINUTE
    started = time.perf_counter()
    early: int | None = None
    with accelerated(RATE) as (arm, stream):
        checker = Checker(arm)
        share = spent = 0.0
        started_at = arm.now
        while share < 1.0 and (bound is None or spent < bound):
            for _ in range(CHUNK):
                sample = next(stream)
                reading = sample.readings[0]
                checker.check(
                    sample.number,
                    sample.period,
                    reading.value,
                    reading.requested_at,
                    reading.replied_at,
                )
            share = (arm.now - started_at) / DAY
            spent = time.perf_counter() - started
            if early is None and (share if bound is None else spent / bound) >= 0.1:
                early = _resident()
        report = stream.report
    assert early is not None, "a tenth of the run comes before its end"
    grown = _resident() - early
    periods = round((arm.now - started_at) * RATE)
    assert abs(report.periods - periods) <= 1, "every period has a sample, or is counted as missed"
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
    """Return the resident memory of this process in bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


if __name__ == "__main__":
    main()
