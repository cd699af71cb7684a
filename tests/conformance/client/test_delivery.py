"""The referee delivers replies after a delay, and with the faults of a scenario."""

from __future__ import annotations

import pytest

from cobotwire.conformance.client import FAULTS, Referee, faulty_replies
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import Late, Scenario
from cobotwire.simulator.faults.noise import COMMAND_ERROR, LEAKS
from playing import play

REQUEST, REPLY = bytes.fromhex("FEFE0212FA"), bytes.fromhex("FEFE031201FA")
SERVO_PACKET = LEAKS["status"]


def _replies(*faults: str, every: int = 1, requests: int = 1) -> list[tuple[float, bytes]]:
    """Send a request each second; return the time and the bytes of each reply."""
    clock = SteppedClock()
    referee = Referee(TABLE, scenario=faulty_replies(0.008, faults, every), clock=clock)
    writes = [(float(number > 0), REQUEST) for number in range(requests)]
    received = play(referee, clock, [*writes, (1.0, b"")])
    return [(round(at, 3), data) for at, data in received]


def test_each_fault_changes_the_reply_as_its_name_says() -> None:
    assert _replies("lost") == []
    assert _replies("late") == [(0.608, REPLY)]
    assert _replies("noise") == [(0.008, SERVO_PACKET + REPLY)]
    assert _replies("text") == [(0.008, COMMAND_ERROR), (0.028, REPLY)]
    assert _replies("twice") == [(0.008, REPLY * 2)]
    assert _replies("merged", every=2, requests=3) == [(0.008, REPLY), (2.008, REPLY * 2)]
    (first, head), (second, tail) = _replies("split")
    assert (first, second, head + tail) == (0.008, 0.058, REPLY)


@pytest.mark.parametrize(("faults", "every"), [(["lots"], 1), (["lost"], 0)])
def test_unknown_fault_and_period_are_rejected(faults: list[str], every: int) -> None:
    with pytest.raises(UsageError, match="misbehave" if every else "every"):
        faulty_replies(0.0, faults, every)


def test_every_fault_is_tested_here() -> None:
    # Events and addresses have tests of their own: test_other_messages.py.
    others = {"event", "address"}
    assert set(FAULTS) == {"lost", "late", "split", "merged", "noise", "text", "twice", *others}


GET_ANGLES = bytes.fromhex("FEFE0220FA")


@pytest.mark.parametrize(("next_at", "waits"), [(0.206, False), (0.210, True)])
def test_late_reply_to_an_equal_request_ends_the_wait(next_at: float, *, waits: bool) -> None:
    clock = SteppedClock()
    late = Late(every=9, first=1, seconds=0.2)
    scenario = Scenario(name="late", faults=(Late(seconds=0.008), late))
    referee = Referee(TABLE, scenario=scenario, clock=clock)
    # The first request has its reply after 208 ms, the third would have it after 213 ms.
    writes = [(0.0, REQUEST), (0.1, REQUEST), (0.105, REQUEST), (next_at - 0.205, GET_ANGLES)]
    play(referee, clock, [*writes, (1.0, b"")])
    failed = {result.case for result in referee.finish().failures}
    assert failed == (set() if waits else {"reply-awaited"})


def test_late_replies_come_alternately_after_three_and_four_requests() -> None:
    late = [at for at, _ in _replies("late", every=3, requests=15) if at % 1 > 0.5]
    assert [int(at) + 1 for at in late] == [3, 7, 10, 14]
