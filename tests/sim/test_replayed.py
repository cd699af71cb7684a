"""A recorded arm answers as it did."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.capture import Packet, Piece
from cobotwire.editions.mycobot import TABLE
from cobotwire.sim import Heard, ReplayedArm

ASK = bytes.fromhex("FE FE 02 20 FA")
POWER = bytes.fromhex("FE FE 02 12 FA")
OFF, ON = bytes.fromhex("FE FE 03 12 00 FA"), bytes.fromhex("FE FE 03 12 01 FA")
MS = 1_000_000


class Clock:
    """Time that passes when it is told to."""

    def __init__(self) -> None:
        self.now = 50.0

    def __call__(self) -> float:
        return self.now


def replayed(
    *packets: Packet, speed: float = 1.0, watch: list[Heard] | None = None
) -> tuple[ReplayedArm, Clock]:
    clock = Clock()
    told = None if watch is None else watch.append
    arm = ReplayedArm(packets, codecs.load(TABLE), speed=speed, clock=clock, watch=told)
    return arm, clock


def let_pass(arm: ReplayedArm, clock: Clock, seconds: float) -> list[tuple[float, bytes]]:
    """What it says meanwhile, and how long after the beginning."""
    start, end = clock.now, clock.now + seconds
    said = []
    while arm.wait is not None and clock.now + arm.wait <= end:
        # A hair beyond, or the sum of two numbers may fall short of the third.
        clock.now += arm.wait + 1e-9
        if data := arm.flush():
            said.append((round(clock.now - start, 6), data))
    clock.now = max(clock.now, end)
    return said


def test_an_answer_comes_with_the_delay_that_it_had() -> None:
    arm, clock = replayed(Packet(0, "sent", POWER), Packet(30 * MS, "heard", ON))
    assert arm.receive(POWER) == b""
    assert let_pass(arm, clock, 1.0) == [(0.03, ON)]
    assert arm.wait is None


def test_speed_divides_the_delays() -> None:
    arm, clock = replayed(Packet(0, "sent", POWER), Packet(30 * MS, "heard", ON), speed=10)
    arm.receive(POWER)
    assert let_pass(arm, clock, 1.0) == [(0.003, ON)]


def test_a_pause_within_a_frame_is_kept() -> None:
    pieces = (Piece(2, 10 * MS), Piece(4, 110 * MS))
    arm, clock = replayed(Packet(0, "sent", POWER), Packet(10 * MS, "heard", ON, pieces=pieces))
    arm.receive(POWER)
    assert let_pass(arm, clock, 1.0) == [(0.01, ON[:2]), (0.11, ON[2:])]


def test_the_same_question_gets_its_answers_in_their_order_and_then_again() -> None:
    arm, _ = replayed(
        Packet(0, "sent", POWER),
        Packet(0, "heard", OFF),
        Packet(1000 * MS, "sent", POWER),
        Packet(1000 * MS, "heard", ON),
    )
    assert [arm.receive(POWER) for _ in range(4)] == [OFF, ON, OFF, ON]


def test_what_was_not_asked_then_is_not_answered_and_told() -> None:
    watched: list[Heard] = []
    arm, _ = replayed(Packet(0, "sent", POWER), Packet(0, "heard", ON), watch=watched)
    assert arm.receive(ASK + POWER) == ON
    assert watched == [Heard(ASK, None), Heard(POWER, len(ON))]


def test_silence_and_noise_are_recorded_too() -> None:
    watched: list[Heard] = []
    arm, clock = replayed(
        Packet(0, "heard", b"before anything was asked"),
        Packet(1 * MS, "sent", ASK),
        Packet(2 * MS, "sent", POWER),
        Packet(3 * MS, "heard", b"Guru", "noise", "no-header"),
        watch=watched,
    )
    arm.receive(ASK)
    assert let_pass(arm, clock, 1.0) == []
    arm.receive(POWER)
    assert let_pass(arm, clock, 1.0) == [(0.001, b"Guru")]
    assert [heard.answer for heard in watched] == [0, 4]


def test_half_a_request_is_given_up_after_a_while() -> None:
    watched: list[Heard] = []
    arm, clock = replayed(Packet(0, "sent", POWER), Packet(0, "heard", ON), watch=watched)
    assert arm.receive(POWER[:3]) == b""
    assert let_pass(arm, clock, 1.0) == []
    assert b"".join(heard.data for heard in watched) == POWER[:3]
    assert arm.receive(POWER) == ON


@pytest.mark.parametrize("cut", range(1, len(POWER)))
def test_a_request_may_come_in_pieces(cut: int) -> None:
    arm, _ = replayed(Packet(0, "sent", POWER), Packet(0, "heard", ON))
    assert arm.receive(POWER[:cut]) + arm.receive(POWER[cut:]) == ON


@given(st.lists(st.tuples(st.sampled_from([ASK, POWER]), st.binary(max_size=8), st.integers(0, 9))))
def test_who_does_the_same_again_hears_the_same_again(
    exchanges: list[tuple[bytes, bytes, int]],
) -> None:
    packets = []
    for number, (request, answer, delay) in enumerate(exchanges):
        start = number * 1000 * MS
        packets += [Packet(start, "sent", request), Packet(start + delay * MS, "heard", answer)]
    arm, clock = replayed(*packets)
    for request, answer, _ in exchanges:
        said = arm.receive(request)
        said += b"".join(data for _, data in let_pass(arm, clock, 1.0))
        assert said == answer
