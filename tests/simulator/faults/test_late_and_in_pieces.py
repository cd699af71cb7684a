"""Test requests in pieces, and a peer that replies late."""

from __future__ import annotations

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import (
    AppliedFault,
    CommandError,
    Echo,
    Fault,
    Late,
    Scenario,
    Silent,
    Stalled,
)
from cobotwire.simulator.peer import Peer
from faulty_talk import CODEC, IS_POWERED, OFF, talk
from playing import play

TEXT = b"cmd_len error\r\n"
ACCOUNT = bytes.fromhex("FE FE 02 B0 FA"), b"home(secret)"
REPLIES_AFTER = 0.5


def slow_arm(clock: SteppedClock) -> Peer:
    """Return an arm that replies to each request late."""
    scenario = Scenario(name="slow", faults=(Late(seconds=REPLIES_AFTER),))
    return scenario.wrap(SimulatedArm(TABLE, clock=clock), CODEC, clock=clock)


def received_from_slow(*faults: Fault) -> tuple[list[tuple[float, bytes]], list[AppliedFault]]:
    clock, applied = SteppedClock(), list[AppliedFault]()
    scenario = Scenario(name="test", faults=faults)
    peer = scenario.wrap(slow_arm(clock), CODEC, clock=clock, on_fault=applied.append)
    return play(peer, clock, [(0.0, IS_POWERED), (10.0, b"")]), applied


@pytest.mark.parametrize("size", [1, 2, None])
def test_malformed_input_is_echoed_completely_for_any_chunking(size: int | None) -> None:
    played = talk([Echo(only="malformed input")], [b"abcde", 1.0, b"fg"], size=size)
    assert played.data == b"abcdefg"


@pytest.mark.parametrize("size", [1, None])
def test_text_after_a_request_is_echoed(size: int | None) -> None:
    assert talk([Echo()], [*ACCOUNT], size=size).data.startswith(b"".join(ACCOUNT))


def test_one_piece_of_malformed_input_gets_one_error() -> None:
    assert talk([CommandError()], [b"abcde"], size=1).data == TEXT


@pytest.mark.parametrize(
    ("fault", "expected"),
    [
        (Echo(), [(0.0, IS_POWERED), (0.5, OFF)]),
        (CommandError(only="requests"), [(0.0, TEXT), (0.5, OFF)]),
        (Stalled(seconds=0.7), [(0.7, OFF)]),
        (Stalled(seconds=0.2), [(0.5, OFF)]),
    ],
)
def test_fault_of_a_request_is_not_applied_to_a_late_reply_again(
    fault: Fault, expected: list[tuple[float, bytes]]
) -> None:
    received, applied = received_from_slow(fault)
    assert [data for _, data in received] == [data for _, data in expected]
    assert [at for at, _ in received] == pytest.approx([at for at, _ in expected])
    assert len(applied) == 1


def test_silent_arm_loses_its_late_reply() -> None:
    clock, applied = SteppedClock(), list[AppliedFault]()
    scenario = Scenario(name="test", faults=(Silent(nth=(2,), seconds=1),))
    peer = scenario.wrap(slow_arm(clock), CODEC, clock=clock, on_fault=applied.append)
    assert play(peer, clock, [(0.0, IS_POWERED), (0.2, IS_POWERED), (5.0, b"")]) == []
    assert [(one.fault, one.added) for one in applied] == [("silent", 0), ("deaf", -len(OFF))]
