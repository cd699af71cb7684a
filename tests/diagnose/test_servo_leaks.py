"""Recognise servo packets that leak onto the line, as seen in the field."""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Codec, Frame
from cobotwire.diagnose import ServoPacket
from cobotwire.simulator.faults import noise
from diagnosing import (
    ANGLES,
    FRAME,
    PING,
    READ,
    STATUS,
    SYNC_READ,
    SYNC_WRITE,
    diagnose,
    kinds,
    only,
)


def test_read_instruction_names_servo_register_and_size(codec: Codec) -> None:
    packet = only(codec, READ)
    assert isinstance(packet, ServoPacket)
    assert (packet.servo, packet.role, packet.instruction) == (1, "instruction", "read")
    assert (packet.register, packet.register_name) == (0x38, "present position")
    assert packet.count == 2
    # Error bits 0x02 and two bytes of data would look the same.
    assert packet.ambiguous


def test_status_packet_has_a_register_only_after_its_instruction(codec: Codec) -> None:
    alone = only(codec, STATUS)
    assert isinstance(alone, ServoPacket)
    assert (alone.role, alone.error, alone.parameters) == ("status", 0, b"\xff\x07")
    assert (alone.register, alone.ambiguous) == (None, False)
    _, status = diagnose(codec, READ + STATUS)
    assert isinstance(status, ServoPacket)
    assert status.register_name == "present position"
    *_, second = diagnose(codec, READ + STATUS + STATUS)
    assert isinstance(second, ServoPacket)
    assert second.register is None, "an instruction has one status packet"


def test_repeated_read_instruction_is_not_a_status_packet(codec: Codec) -> None:
    assert all(
        i.role == "instruction" for i in diagnose(codec, READ * 3) if isinstance(i, ServoPacket)
    )


def test_sync_read_assigns_its_register_to_the_status_of_each_servo(codec: Codec) -> None:
    replies = b"".join(noise.servo_packet(bytes([id, 17, 0]) + bytes(15)) for id in range(1, 7))
    first, *statuses = diagnose(codec, SYNC_READ + replies)
    assert isinstance(first, ServoPacket)
    assert (first.instruction, first.servo, first.ambiguous) == ("sync read", 0xFE, False)
    assert (first.register, first.count, first.servos) == (0x38, 15, (1, 2, 3, 4, 5, 6))
    assert [(i.servo, i.register) for i in statuses if isinstance(i, ServoPacket)] == [
        (id, 0x38) for id in range(1, 7)
    ]


def test_sync_write_names_register_size_and_servos(codec: Codec) -> None:
    packet = only(codec, SYNC_WRITE)
    assert isinstance(packet, ServoPacket)
    assert (packet.instruction, packet.register_name) == ("sync write", "acceleration")
    assert (packet.count, packet.servos) == (7, (6,))


def test_ping_names_its_servo(codec: Codec) -> None:
    packet = only(codec, PING)
    assert isinstance(packet, ServoPacket)
    assert (packet.instruction, packet.servo, packet.register) == ("ping", 7, None)


def test_status_with_an_error_bit_describes_the_error(codec: Codec) -> None:
    packet = only(codec, noise.servo_packet(b"\x03\x02\x20"))
    assert isinstance(packet, ServoPacket)
    assert (packet.role, packet.error, packet.ambiguous) == ("status", 0x20, False)
    assert "overload" in packet.describe()


@pytest.mark.parametrize("frame", [FRAME, ANGLES])
def test_servo_packet_with_checksum_fe_does_not_hide_the_next_frame(
    codec: Codec, frame: bytes
) -> None:
    packet = noise.servo_packet(bytes.fromhex("01 04 00 00 fc"))
    assert packet.endswith(b"\xfe")
    items = diagnose(codec, packet + frame)
    assert kinds(items) == [ServoPacket, Frame]
    assert [item.data for item in items] == [packet, frame]


def test_servo_packets_between_frames_are_recognised(codec: Codec) -> None:
    stream = READ + FRAME + STATUS + SYNC_READ + ANGLES + PING
    assert kinds(diagnose(codec, stream)) == [
        ServoPacket,
        Frame,
        ServoPacket,
        ServoPacket,
        Frame,
        ServoPacket,
    ]


def test_servo_packet_interrupted_by_frames_is_one_finding_in_pieces(codec: Codec) -> None:
    packet, *frames = diagnose(codec, READ[:5] + FRAME + FRAME + READ[5:])
    assert isinstance(packet, ServoPacket)
    assert [(span.offset, len(span.data)) for span in packet.spans] == [(0, 5), (17, 3)]
    assert [frame.offset for frame in frames] == [5, 11]
    assert all(isinstance(frame, Frame) for frame in frames)


def test_servo_packet_interrupted_by_many_frames_is_not_recognised(codec: Codec) -> None:
    items = diagnose(codec, READ[:5] + FRAME * 20 + READ[5:])
    assert not any(isinstance(item, ServoPacket) for item in items)
