"""Decode a capture to typed messages, and match them."""

from __future__ import annotations

from capture.lines import FRAMES, reader, written
from cobotwire.capture import Packet, Piece
from cobotwire.editions.mycobot.messages import GetAnglesReply, SendAngle
from cobotwire.inspect.captured import messages
from cobotwire.protocol.errors import ProtocolError

QUERY, ANGLES, POWERED = FRAMES[:3]
SEND_ANGLE = bytes.fromhex("FE FE 06 21 01 00 1D 14 FA")


def matched(*packets: Packet) -> list[tuple[int, str, object]]:
    found: list[tuple[int, str, object]] = []
    for captured in messages(reader(written(packets))):
        match captured.message:
            case SendAngle(joint, angle):
                what: object = (joint, angle)
            case GetAnglesReply(angles):
                what = tuple(angles)
            case ProtocolError() as error:
                what = error.reason
            case other:
                what = other.command
        found.append((captured.time_ns, captured.direction, what))
    return found


def test_messages_of_a_capture_match_their_types() -> None:
    angles = (0.01, -0.01, 0.03, 0.04, 0.05, 0.06)
    assert matched(
        Packet(10, "sent", SEND_ANGLE),
        Packet(20, "sent", QUERY),
        Packet(30, "received", ANGLES, pieces=(Piece(4, 30), Piece(13, 40))),
        Packet(50, "received", b"Guru", "noise", "no-header"),
        Packet(60, "received", POWERED),
    ) == [
        (10, "sent", (1, 0.29)),
        (20, "sent", "get_angles"),
        (30, "received", angles),
        (60, "received", "is_power_on"),
    ]


def test_frame_in_two_packets_is_one_message_with_the_time_of_its_first_byte() -> None:
    packets = [Packet(10, "received", POWERED[:2], "bytes"), Packet(25, "received", POWERED[2:])]
    assert matched(*packets) == [(10, "received", "is_power_on")]


def test_message_with_a_value_outside_the_edition_is_its_error() -> None:
    illegal = bytes.fromhex("FE FE 03 2B 07 FA")
    assert matched(Packet(10, "received", illegal)) == [(10, "received", "bad-value")]
