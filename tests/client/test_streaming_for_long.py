"""Stream for minutes of accelerated time."""

from __future__ import annotations

import gc
import sys
import tracemalloc
from itertools import islice

from accelerated import LATE, LOST, Checker, accelerated

SAMPLES = 12_000
# At the end, memory is traced, which takes most of the time; before, objects are counted.
TRACED = 6_000


def test_long_stream_keeps_memory_flat_and_samples_in_order() -> None:
    with accelerated(rate=100.0) as (arm, stream):
        checker = Checker(arm)
        begun = arm.now

        def take(count: int) -> None:
            for sample in islice(stream, count):
                one = sample.readings[0]
                checker.check(
                    sample.number, sample.period, one.value, one.requested_at, one.replied_at
                )
            gc.collect()

        take(SAMPLES // 10)
        before = sys.getallocatedblocks()
        take(SAMPLES - SAMPLES // 10 - TRACED)
        assert sys.getallocatedblocks() - before < 300, "objects"
        tracemalloc.start()
        try:
            take(TRACED // 10)
            early, _ = tracemalloc.get_traced_memory()
            take(TRACED - TRACED // 10)
            late, _ = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert late - early < 5_000, "bytes"
        report = stream.report
        assert arm.now - begun > 120
        assert report.samples == SAMPLES
        # Lost and late replies are counted as unanswered, and every period is accounted for.
        assert report.unanswered == arm.requests // LOST + arm.requests // LATE
        assert report.unread == 0
        assert abs(report.periods - (arm.now - begun) * 100) <= 1.5
