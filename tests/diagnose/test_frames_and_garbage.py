"""Recognise damaged, unlisted and echoed frames, and bytes at a wrong baud rate."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Frame
from cobotwire.diagnose import (
    CommandError,
    DamagedFrame,
    Diagnoser,
    Garbage,
    OppositeFrame,
    ServoPacket,
    UnlistedFrame,
    Unrecognised,
)
from diagnosing import ANGLES, FRAME, READ, diagnose, kinds, only


def test_frames_that_follow_each_other_directly_are_both_recognised(codec: Codec) -> None:
    late = bytes.fromhex("FE FE 03 10 01 FA")
    first, second = diagnose(codec, late + ANGLES)
    # This edition lists no acknowledgement of power_on.
    assert isinstance(first, UnlistedFrame)
    assert (first.id, first.command) == (0x10, "power_on")
    assert second == Frame(6, ANGLES, 0x20)


def test_frame_is_an_echo_for_certain_only_if_the_request_is_known(codec: Codec) -> None:
    request = bytes.fromhex("FE FE 02 20 FA")
    (seen,) = diagnose(codec, request)
    (known,) = diagnose(codec, request, sent=request)
    for item in (seen, known):
        assert isinstance(item, OppositeFrame)
        assert (item.command, item.direction) == ("get_angles", "request")
    assert isinstance(seen, OppositeFrame)
    assert isinstance(known, OppositeFrame)
    assert (seen.sent, known.sent) == (False, True)


def test_reply_among_requests_is_an_opposite_frame(codec: Codec) -> None:
    reply = only(codec, ANGLES, "request")
    assert isinstance(reply, OppositeFrame)
    assert (reply.command, reply.direction, reply.sent) == ("get_angles", "reply", False)


def test_wrong_baud_rate_is_a_guess_with_a_probability(codec: Codec) -> None:
    garbage = only(codec, bytes.fromhex("78 80 78"))
    assert isinstance(garbage, Garbage)
    assert garbage.fitting == 3
    assert garbage.chance == pytest.approx((28 / 256) ** 3)
    assert garbage.describe().startswith("perhaps ")
    assert isinstance(only(codec, bytes.fromhex("02 38 02 be")), Unrecognised)


@pytest.mark.parametrize(
    ("damaged", "reason"),
    [
        ("FE FE 0E 20 00 01 02 03 04 05 06 07 08 09 0A 0B FB", "bad-check"),  # a flipped footer
        ("FE FE 0E 20 00 01 02 03 04 05 06 07 09 0A 0B FA", "bad-check"),  # a byte lost
        ("FE FE 0E 20 00 01 02 03 04 05 06 07 08 08 09 0A 0B FA", "bad-check"),  # one too many
        ("FE FE 0D 20 00 01 02 03 04 05 06 07 08 09 0A 0B FA", "bad-length"),  # a flipped LEN
    ],
)
def test_damaged_frame_ends_before_the_next_frame(codec: Codec, damaged: str, reason: str) -> None:
    data = bytes.fromhex(damaged)
    finding, *rest = diagnose(codec, data + FRAME)
    assert isinstance(finding, DamagedFrame)
    assert (finding.command, finding.reason, finding.data) == ("get_angles", reason, data)
    assert rest == [Frame(len(data), FRAME, 0x12)]


def test_truncated_frame_is_damaged(codec: Codec) -> None:
    finding = only(codec, ANGLES[:9])
    assert isinstance(finding, DamagedFrame)
    assert (finding.command, finding.reason) == ("get_angles", "truncated")
    start = only(codec, ANGLES[:3])
    assert isinstance(start, DamagedFrame)
    assert start.command is None
    items = diagnose(codec, ANGLES[:9] + b"cmd_len error\r\n" + READ)
    assert kinds(items) == [DamagedFrame, CommandError, ServoPacket]


def test_frame_that_a_flush_cuts_in_two_is_damaged_and_not_an_echo(codec: Codec) -> None:
    framer, diagnoser = codec.framer("reply"), Diagnoser(codec)
    events = [*framer.feed(FRAME[:3]), *framer.flush(), *framer.feed(FRAME[3:]), *framer.flush()]
    (finding,) = diagnoser.feed(events) + diagnoser.flush()
    assert isinstance(finding, DamagedFrame)
    assert (finding.command, finding.reason, finding.data) == ("is_power_on", "truncated", FRAME)


def test_frame_with_an_unknown_id_is_unlisted(codec: Codec) -> None:
    finding = only(codec, bytes.fromhex("FE FE 04 E0 01 02 FA"))
    assert isinstance(finding, UnlistedFrame)
    assert (finding.id, finding.command) == (0xE0, None)
