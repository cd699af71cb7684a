"""Stream for a minute of stepped time, from a simulated arm that numbers its replies."""

from __future__ import annotations

import gc
import sys
import tracemalloc
from itertools import islice

from cobotwire import codec as codecs
from cobotwire.editions.mycobot import TABLE, Angles, GetAngles, MyCobot
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire.simulator.behaviour import Behaviours
from cobotwire.simulator.faults import Late, Lost, Scenario

SAMPLES = 6_500
# Memory is traced only for the last samples, since that is slow; before, objects are counted.
TRACED = 1_500
# Every n-th reply is lost, 30 ms late, or later than its deadline of 500 ms.
LOST, LATE = 2_500, 5_503
FAULTS = (
    Late(seconds=0.008),
    Lost(every=LOST),
    Late(seconds=0.03, every=3_501),
    Late(seconds=0.7, every=LATE),
)


def test_long_stream_keeps_memory_flat_and_samples_in_order() -> None:
    requests = 0

    def numbered(arm: object, now: float, request: GetAngles) -> Angles:
        nonlocal requests
        requests += 1
        high, low = divmod(requests, 10_000)
        return Angles(low / 100, high / 100, 0.0, 0.0, 0.0, 0.0)

    behaviours = Behaviours()
    behaviours.query(GetAngles, numbered)
    clock = SteppedClock()
    arm = SimulatedArm(TABLE, clock=clock, behaviours=behaviours)
    peer = Scenario(name="long", faults=FAULTS).wrap(arm, codecs.load(TABLE), clock=clock)
    transport = MemoryTransport(peer, clock)
    with MyCobot(transport) as client, client.stream(GetAngles(), rate=100.0) as stream:
        begun, last = clock(), (-1, -1, -1.0)

        def take(count: int) -> None:
            nonlocal last
            for sample in islice(stream, count):
                [one] = sample.readings
                low, high, *_ = one.value
                assert round(100 * low) + 10_000 * round(100 * high) == requests, "an older reply"
                this = (sample.number, sample.period, one.replied_at)
                assert all(new > old for new, old in zip(this, last)), (this, last)
                assert last[2] <= one.requested_at < one.replied_at <= clock()
                last = this
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
        assert late - early < 2_500, "bytes"
        report = stream.report
        assert clock() - begun > 60
        assert report.samples == SAMPLES
        # Lost and late replies are counted as unanswered, and every period is accounted for.
        assert report.unanswered == requests // LOST + requests // LATE
        assert report.unread == 0
        assert abs(report.periods - (clock() - begun) * 100) <= 1.5
