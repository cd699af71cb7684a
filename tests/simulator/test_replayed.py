"""Test that a recorded arm replies as it was recorded."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.capture import Packet, Piece
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import ReplayedArm, ReplayedRequest, SteppedClock
from playing import play

QUERY = bytes.fromhex("FE FE 02 20 FA")
POWER = bytes.fromhex("FE FE 02 12 FA")
OFF, ON = bytes.fromhex("FE FE 03 12 00 FA"), bytes.fromhex("FE FE 03 12 01 FA")
MS = 1_000_000


def replayed(
    *packets: Packet, speed: float = 1.0, on_request: list[ReplayedRequest] | None = None
) -> tuple[ReplayedArm, SteppedClock]:
    clock = SteppedClock(50.0)
    append = None if on_request is None else on_request.append
    arm = ReplayedArm(packets, codecs.load(TABLE), speed=speed, clock=clock, on_request=append)
    return arm, clock


def let_pass(arm: ReplayedArm, clock: SteppedClock, seconds: float) -> list[tuple[float, bytes]]:
    """Let time pass; return what the arm sends, each with its seconds since the beginning."""
    start = clock()
    return [(round(at - start, 4), data) for at, data in play(arm, clock, [(seconds, b"")])]


def test_replay_speed_divides_the_delays() -> None:
    arm, clock = replayed(Packet(0, "sent", POWER), Packet(30 * MS, "received", ON), speed=10)
    arm.receive(POWER)
    assert let_pass(arm, clock, 1.0) == [(0.003, ON)]


def test_replayed_frame_keeps_its_pause() -> None:
    pieces = (Piece(2, 10 * MS), Piece(4, 110 * MS))
    arm, clock = replayed(Packet(0, "sent", POWER), Packet(10 * MS, "received", ON, pieces=pieces))
    arm.receive(POWER)
    assert let_pass(arm, clock, 1.0) == [(0.01, ON[:2]), (0.11, ON[2:])]


def test_request_that_was_not_recorded_gets_no_reply_and_is_reported() -> None:
    watched: list[ReplayedRequest] = []
    arm, _ = replayed(Packet(0, "sent", POWER), Packet(0, "received", ON), on_request=watched)
    assert arm.receive(QUERY + POWER) == ON
    assert watched == [ReplayedRequest(QUERY, None), ReplayedRequest(POWER, len(ON))]


def test_recorded_silence_and_noise_are_replayed() -> None:
    watched: list[ReplayedRequest] = []
    arm, clock = replayed(
        Packet(0, "received", b"before the first request"),
        Packet(1 * MS, "sent", QUERY),
        Packet(2 * MS, "sent", POWER),
        Packet(3 * MS, "received", b"Guru", "noise", "no-header"),
        on_request=watched,
    )
    arm.receive(QUERY)
    assert let_pass(arm, clock, 1.0) == []
    arm.receive(POWER)
    assert let_pass(arm, clock, 1.0) == [(0.001, b"Guru")]
    assert [request.reply_size for request in watched] == [0, 4]


def test_incomplete_request_to_a_recording_is_given_up() -> None:
    watched: list[ReplayedRequest] = []
    arm, clock = replayed(Packet(0, "sent", POWER), Packet(0, "received", ON), on_request=watched)
    assert arm.receive(POWER[:3]) == b""
    assert let_pass(arm, clock, 1.0) == []
    assert b"".join(request.data for request in watched) == POWER[:3]
    assert arm.receive(POWER) == ON


@given(
    st.lists(st.tuples(st.sampled_from([QUERY, POWER]), st.binary(max_size=8), st.integers(0, 9)))
)
def test_repeated_session_gets_the_same_replies(
    exchanges: list[tuple[bytes, bytes, int]],
) -> None:
    packets = []
    for number, (request, reply, delay) in enumerate(exchanges):
        start = number * 1000 * MS
        packets += [Packet(start, "sent", request), Packet(start + delay * MS, "received", reply)]
    arm, clock = replayed(*packets)
    for request, reply, _ in exchanges:
        received = arm.receive(request)
        received += b"".join(data for _, data in let_pass(arm, clock, 1.0))
        assert received == reply
