"""Run the examples that move arms, on simulated arms; a page of the guide includes these files."""

from __future__ import annotations

import asyncio
import runpy
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from cobotwire import LinkError
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm
from vectors import ROOT

FOLDER = ROOT / "examples"
MOVING = ("pick_and_place", "teach_and_replay", "two_arms")
# The seconds of the arm's clock in a real second.
RATE = 50.0


class _Arms:
    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack

    def new(self, rate: float = RATE, **options: Any) -> tuple[SimulatedArm, str]:
        """Return a simulated arm, served on a pty, and its port."""
        clock = RunningClock(rate)
        arm = SimulatedArm(TABLE, clock=clock, **options)
        return arm, self._stack.enter_context(PtyServer(arm, clock)).url


@pytest.fixture
def arms() -> Iterator[_Arms]:
    with ExitStack() as stack:
        yield _Arms(stack)


def load(name: str) -> dict[str, Any]:
    return runpy.run_path(str(FOLDER / f"{name}.py"))


def test_page_of_the_guide_shows_these_programs() -> None:
    page = (ROOT / "docs" / "guide" / "programs.md").read_text(encoding="utf-8")
    assert [name for name in MOVING if f"}} ../../examples/{name}.py\n" not in page] == []


def test_pick_and_place_grips_at_one_place_and_opens_at_the_other(
    arms: _Arms, capsys: pytest.CaptureFixture[str]
) -> None:
    arm, port = arms.new()
    program = load("pick_and_place")
    program["main"](port)
    lines = capsys.readouterr().out.splitlines()
    closed, opened = program["CLOSED"], program["OPEN"]
    assert lines[:2] == [f"gripper at {closed} percent", f"gripper at {opened} percent"]
    assert arm.state.angles.target(0.0) == pytest.approx(program["READY"], abs=0.1)
    assert [note for note in arm.notes if "ignored" in note.text or "rejected" in note.text] == []


def test_teach_and_replay_repeats_the_path_of_the_hand(arms: _Arms) -> None:
    # Slow enough that a busy machine takes some samples on the way.
    arm, port = arms.new(rate=10.0, powered=True)
    last = (40.0, -30.0, 10.0, 0.0, 0.0, 20.0)
    arm.lead([(5.0, (40.0, 0.0, 0.0, 0.0, 0.0, 0.0)), (15.0, last)])
    path = load("teach_and_replay")["main"](port, 2.0)
    assert len(path) > 3
    assert path[-1] == pytest.approx(last, abs=0.1)
    assert arm.state.angles.target(0.0) == pytest.approx(last, abs=0.1)


def test_two_arms_move_in_step(arms: _Arms, capsys: pytest.CaptureFixture[str]) -> None:
    (_, left), (_, right) = arms.new(), arms.new()
    asyncio.run(load("two_arms")["main"](left, right))
    *lines, end = capsys.readouterr().out.splitlines()
    assert end == "both arms are back"
    found = [(line.split()[0], round(float(line.split()[-1]))) for line in lines]
    for at, angle in enumerate((40, -40, 0)):
        assert sorted(found[2 * at : 2 * at + 2]) == sorted([(left, angle), (right, -angle)])


def test_failure_of_one_of_two_arms_ends_the_other(arms: _Arms, tmp_path: Path) -> None:
    _, left = arms.new()
    with pytest.raises(ExceptionGroup) as caught:
        asyncio.run(load("two_arms")["main"](left, str(tmp_path / "nothing")))
    assert caught.group_contains(LinkError)
