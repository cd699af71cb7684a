"""Requests that come in pieces, and a peer that answers later, by itself."""

from __future__ import annotations

import pytest

from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.faults import CommandError, Done, Echo, Fault, Scenario, Silent, Stalled
from faulty_talk import CODEC, IS_POWERED, OFF, pass_time, talk

TEXT = b"cmd_len error\r\n"
ACCOUNT = bytes.fromhex("FE FE 02 B0 FA"), b"home(secret)"
ANSWERS_AFTER = 0.5


class Slow:
    """A peer that answers each request later."""

    def __init__(self, clock: SteppedClock) -> None:
        self._clock = clock
        self._due: float | None = None

    @property
    def wait(self) -> float | None:
        return None if self._due is None else max(0.0, self._due - self._clock())

    def receive(self, data: bytes) -> bytes:
        self._due = self._clock() + ANSWERS_AFTER
        return b""

    def flush(self) -> bytes:
        self._due = None
        return OFF


def heard_of_slow(*faults: Fault) -> tuple[list[tuple[float, bytes]], list[Done]]:
    clock, done = SteppedClock(), list[Done]()
    scenario = Scenario(name="test", faults=faults)
    peer = scenario.wrap(Slow(clock), CODEC, clock=clock, watch=done.append)
    said = peer.receive(IS_POWERED)
    heard = [(clock(), said)] if said else []
    pass_time(peer, clock, 10.0, heard)
    return heard, done


@pytest.mark.parametrize("size", [1, 2, None])
def test_all_of_malformed_input_is_echoed_however_it_comes(size: int | None) -> None:
    played = talk([Echo(only="malformed input")], [b"abcde", 1.0, b"fg"], size=size)
    assert played.data == b"abcdefg"


@pytest.mark.parametrize("size", [1, None])
def test_the_text_behind_a_request_is_echoed_too(size: int | None) -> None:
    assert talk([Echo()], [*ACCOUNT], size=size).data.startswith(b"".join(ACCOUNT))


def test_one_piece_of_malformed_input_is_one_error() -> None:
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
def test_what_is_done_as_a_request_is_heard_is_done_once(
    fault: Fault, expected: list[tuple[float, bytes]]
) -> None:
    heard, done = heard_of_slow(fault)
    assert [data for _, data in heard] == [data for _, data in expected]
    assert [at for at, _ in heard] == pytest.approx([at for at, _ in expected])
    assert len(done) == 1


def test_a_silent_arm_does_not_say_what_it_would_have_said_later() -> None:
    clock, done = SteppedClock(), list[Done]()
    scenario = Scenario(name="test", faults=(Silent(nth=(2,), seconds=1),))
    peer = scenario.wrap(Slow(clock), CODEC, clock=clock, watch=done.append)
    assert peer.receive(IS_POWERED) == b""
    clock.sleep(0.2)
    assert peer.receive(IS_POWERED) == b""
    heard: list[tuple[float, bytes]] = []
    pass_time(peer, clock, 5.0, heard)
    assert heard == []
    assert [(one.fault, one.added) for one in done] == [("silent", 0), ("deaf", -len(OFF))]
