"""After Ctrl-C anywhere in a run, the arm is at rest and its settings are restored."""

from __future__ import annotations

from itertools import count

import pytest

from cobotwire import editions
from cobotwire.conformance import Cause
from cobotwire.conformance.device import DeviceConnection, Tester
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from conformance.device.testing import HELD, permissions, settings_of

TABLE = editions.load("mycobot").TABLE
ALLOWED = permissions("setting", "persistent-write", "power", "motion")
# Seconds in which a stopped joint comes to rest.
SLOWS_DOWN = 0.5


class CutShort(MemoryTransport):
    """A transport that raises KeyboardInterrupt in place of some writes."""

    def __init__(self, arm: SimulatedArm, clock: SteppedClock, cuts: frozenset[int]) -> None:
        super().__init__(arm, clock)
        self._numbers = count()
        self._cuts = cuts

    def write(self, data: bytes) -> None:
        if next(self._numbers) in self._cuts:
            raise KeyboardInterrupt
        super().write(data)

    @property
    def written(self) -> int:
        """The number of writes so far; reading it counts as a write."""
        return next(self._numbers)


def _run(*cuts: int) -> tuple[SimulatedArm, CutShort, Tester]:
    clock = SteppedClock()
    arm = SimulatedArm(TABLE, clock=clock)
    transport = CutShort(arm, clock, frozenset(cuts))
    tester = Tester(DeviceConnection(transport, clock), TABLE, permissions=ALLOWED)
    if cuts:
        with pytest.raises(KeyboardInterrupt):
            tester.run()
    else:
        tester.run()
    return arm, transport, tester


@pytest.fixture(scope="module")
def writes() -> int:
    _, transport, tester = _run()
    assert tester.report.finished
    return transport.written


def _is_as_before(arm: SimulatedArm, transport: CutShort) -> None:
    transport.clock.sleep(SLOWS_DOWN)
    assert not arm.state.angles.moving(transport.clock())
    assert settings_of(arm, but=HELD) == settings_of(SimulatedArm(TABLE), but=HELD)


@pytest.mark.parametrize("share", [0.05, 0.2, 0.35, 0.5, 0.62, 0.71, 0.8, 0.86, 0.9, 0.95, 0.99])
def test_interrupt_anywhere_restores_the_arm(writes: int, share: float) -> None:
    arm, transport, tester = _run(int(writes * share))
    _is_as_before(arm, transport)
    report = tester.report
    assert not report.finished
    assert report.stopped == "the run was interrupted"
    left = [result for result in report.results if result.cause is Cause.RUN_ENDED]
    assert left[-1].case == "acknowledgements-alike"
    # Every step of a whole run has its results.
    places = {(result.group, result.command) for result in report.results}
    assert places == {step.place for step in tester.steps()}


def test_interrupt_while_the_arm_returns_restores_the_arm(writes: int) -> None:
    # The last writes poll whether the arm is back.
    arm, transport, tester = _run(writes - 8)
    _is_as_before(arm, transport)
    assert not tester.report.finished


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_second_interrupt_while_restoring_restores_the_arm(writes: int, share: float) -> None:
    first = int(writes * share)
    arm, transport, _ = _run(first, first + 2)
    _is_as_before(arm, transport)
