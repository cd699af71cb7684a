"""Ctrl-C at any place of a run: the arm stands, and what was set is set back."""

from __future__ import annotations

from itertools import count

import pytest

from cobotwire import editions
from cobotwire.conformance.device import Line, Tester
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.memory import MemoryLink
from conformance.device.testing import HELD, leave, settings_of

TABLE = editions.load("mycobot").TABLE
ALLOWED = leave("setting", "persistent-write", "power", "motion")
# A joint that is stopped needs a moment to stand, in seconds.
SLOWS_DOWN = 0.5


class CutShort(MemoryLink):
    """A link on which the user presses Ctrl-C instead of some writes."""

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
        """How many writes there were until now; counts as one."""
        return next(self._numbers)


def _run(*cuts: int) -> tuple[SimulatedArm, CutShort, Tester]:
    clock = SteppedClock()
    arm = SimulatedArm(TABLE, clock=clock)
    link = CutShort(arm, clock, frozenset(cuts))
    tester = Tester(Line(link, clock), TABLE, leave=ALLOWED)
    if cuts:
        with pytest.raises(KeyboardInterrupt):
            tester.run()
    else:
        tester.run()
    return arm, link, tester


@pytest.fixture(scope="module")
def whole() -> int:
    _, link, tester = _run()
    assert tester.report.finished
    return link.written


def _is_as_before(arm: SimulatedArm, link: CutShort) -> None:
    link.clock.sleep(SLOWS_DOWN)
    assert not arm.state.angles.moving(link.clock())
    assert settings_of(arm, but=HELD) == settings_of(SimulatedArm(TABLE), but=HELD)


@pytest.mark.parametrize("share", [0.05, 0.2, 0.35, 0.5, 0.62, 0.71, 0.8, 0.86, 0.9, 0.95, 0.99])
def test_anywhere(whole: int, share: float) -> None:
    arm, link, tester = _run(int(whole * share))
    _is_as_before(arm, link)
    assert not tester.report.finished
    assert tester.report.results


def test_on_the_way_back_at_the_end(whole: int) -> None:
    # The last writes ask again and again whether the arm is back yet.
    arm, link, tester = _run(whole - 8)
    _is_as_before(arm, link)
    assert not tester.report.finished


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_again_while_it_sets_back(whole: int, share: float) -> None:
    first = int(whole * share)
    arm, link, _ = _run(first, first + 2)
    _is_as_before(arm, link)
