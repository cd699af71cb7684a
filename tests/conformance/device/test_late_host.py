"""A device does not fail because the host stalls. The clock is stepped, so load does not matter.

A stall is a pause of the host between a request and the next read of the port.
"""

from __future__ import annotations

import pytest

import vectors
from cobotwire.conformance import Cause, Report, Verdict
from cobotwire.conformance.device import ALL_PERMISSIONS, DeviceConnection
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from conformance.device.testing import permissions
from defects.arm.closed_loop import closed_loop_arm
from defects.devices import CLOSED_LOOP, OurTester


class StallingTransport(MemoryTransport):
    """A connection that stalls for ``seconds`` after every ``every``-th write."""

    every, seconds, _writes = 1, 0.0, 0

    def write(self, data: bytes) -> None:
        """Send, and let time pass."""
        super().write(data)
        self._writes += 1
        if self._writes % self.every == 0:
            self.clock.sleep(self.seconds)


def run(arm: str, every: int, seconds: float, table: Table = CLOSED_LOOP) -> Report:
    clock = SteppedClock()
    transport = StallingTransport(closed_loop_arm(clock, arm), clock)
    transport.every, transport.seconds = every, seconds
    allowed = permissions(*ALL_PERMISSIONS)
    return OurTester(DeviceConnection(transport, clock), table, permissions=allowed).run()


STALLS = [(2, 0.02), (3, 0.06), (5, 0.3), (7, 0.8), (13, 3.0)]
ARMS = ["", "acknowledges-late", "fast"]


@pytest.mark.parametrize(("arm", "stall"), vectors.sampled_pairs(ARMS, STALLS))
def test_device_does_not_fail_because_the_host_stalls(arm: str, stall: tuple[int, float]) -> None:
    every, seconds = stall
    report = run(arm, every, seconds)
    assert [f"{r.group}, {r.case} {r.command}: {r.reason}" for r in report.failures] == []


def test_requests_in_pieces_get_no_verdict_if_the_host_is_always_late() -> None:
    report = run("", 2, 0.3)
    found = [result for result in report.results if result.case == "request-in-pieces"]
    assert {result.cause for result in found} == {Cause.NOT_TIMED}
    assert "10 to 310 ms" in found[0].reason


def test_report_shows_the_pauses_that_were_made() -> None:
    report = run("", 1, 0.002)
    found = [result for result in report.results if result.case == "request-in-pieces"]
    assert {result.verdict for result in found} == {Verdict.PASS}
    assert "12 to 12 ms" in found[0].reason


def test_verdict_of_moving_is_not_timed_if_the_arm_arrives_at_once() -> None:
    report = run("very-fast", 1, 0.02)
    found = {r.command: r for r in report.results if r.case == "moving"}
    assert found["send_angles"].outcome == "inconclusive (not timed)"
    assert found["stop"].verdict is Verdict.PASS
