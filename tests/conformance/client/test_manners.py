"""How answers are delivered: after a moment, and badly where that was asked for."""

from __future__ import annotations

import pytest

from cobotwire.conformance.client import MISDEEDS, Manners, Referee
from cobotwire.conformance.client.manners import SERVO_PACKET
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.errors import UsageError
from cobotwire.sim.clock import SteppedClock

ASK, ANSWER = bytes.fromhex("FEFE0212FA"), bytes.fromhex("FEFE031201FA")


def _heard(*misdeeds: str, every: int = 1, asked: int = 1) -> list[tuple[float, bytes]]:
    """What comes of a question each second: when, and what."""
    clock = SteppedClock()
    referee = Referee(TABLE, manners=Manners(0.008, misdeeds, every), clock=clock)
    said: list[tuple[float, bytes]] = []
    for _ in range(asked):
        end = clock() + 1.0
        data = referee.receive(ASK)
        while True:
            if data:
                said.append((round(clock(), 3), data))
            wait = referee.wait
            if wait is None or clock() + wait > end:
                break
            clock.sleep(wait)
            data = referee.flush()
        clock.sleep(end - clock())
    return said


def test_a_good_answer_comes_whole_after_its_moment() -> None:
    assert _heard() == [(0.008, ANSWER)]


def test_each_misdeed_is_what_it_says() -> None:
    assert _heard("lost") == []
    assert _heard("late") == [(0.608, ANSWER)]
    assert _heard("split") == [(0.008, ANSWER[:3]), (0.058, ANSWER[3:])]
    assert _heard("noise") == [(0.008, SERVO_PACKET + ANSWER)]
    assert _heard("twice") == [(0.008, ANSWER * 2)]
    assert _heard("merged", every=2, asked=3) == [(0.008, ANSWER), (2.008, ANSWER * 2)]


def test_misdeeds_take_turns_among_good_answers() -> None:
    told = _heard("lost", "twice", every=2, asked=8)
    assert [data for _, data in told] == [ANSWER, ANSWER, ANSWER * 2] * 2


@pytest.mark.parametrize(("misdeeds", "every"), [(["lots"], 1), (["lost"], 0)])
def test_what_is_no_misdeed_is_refused(misdeeds: list[str], every: int) -> None:
    with pytest.raises(UsageError, match="misbehave" if every else "every"):
        Manners(0.0, misdeeds, every)


def test_every_misdeed_is_tried_here() -> None:
    assert set(MISDEEDS) == {"lost", "late", "split", "merged", "noise", "twice"}
