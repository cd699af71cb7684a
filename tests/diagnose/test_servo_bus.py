"""Compare how servo packets are read with their spec, another spec and plain rules."""

from __future__ import annotations

import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

import field
import vectors
from cobotwire.codec.interface import Codec
from cobotwire.diagnose import ServoPacket
from cobotwire.diagnose.servo import STARTS, packet_size
from cobotwire.diagnose.servo_bus import servo_bus
from cobotwire.simulator.faults import noise
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.model import Vector
from diagnosing import only


def vectors_of(name: str) -> list[Vector]:
    path = vectors.ROOT / name
    return [v for v in build_edition(path, Path(vectors.ROOT)).vectors if v.frame is not None]


def test_instruction_of_each_vector_is_named(codec: Codec) -> None:
    for vector in vectors_of("spec/servo_bus.yaml"):
        assert vector.frame is not None
        packet = only(codec, vector.frame)
        assert isinstance(packet, ServoPacket)
        values = dict(vector.values)
        if vector.direction == "reply":
            assert (packet.role, packet.parameters.hex(" ")) == ("status", _data(values))
            continue
        assert packet.instruction == vector.command.replace("_", " ")
        assert packet.register == values.get("register")
        if "count" in values:
            assert packet.count == values["count"]
        if "servos" in values:
            assert packet.servos == values["servos"]


def _data(values: dict[str, object]) -> str:
    return str(values.get("data", "")).lower()


def test_packets_of_the_typed_feetech_spec_are_recognised(codec: Codec) -> None:
    found = {}
    for vector in vectors_of("tests/protocols/feetech.yaml"):
        assert vector.frame is not None
        packet = only(codec, vector.frame)
        assert isinstance(packet, ServoPacket)
        assert (packet.role == "status") == (vector.direction == "reply")
        found[vector.name] = packet
    assert found["sync"].servos == (1, 2, 3, 4)
    assert (found["sync"].register_name, found["sync"].count) == ("goal position", 6)
    assert found["overload"].errors == ("overload",)


def test_packet_with_unknown_code_is_named_by_its_number(codec: Codec) -> None:
    packet = only(codec, noise.servo_packet(b"\x03\x02\x10"))
    assert isinstance(packet, ServoPacket)
    # Bit 4 is not an error bit, so this is not a status packet.
    assert (packet.role, packet.instruction, packet.errors) == ("instruction", "0x10", ())


def test_second_byte_of_a_register_is_named(codec: Codec) -> None:
    packet = only(codec, noise.servo_packet(b"\x03\x04\x03\x39\x01"))
    assert isinstance(packet, ServoPacket)
    assert packet.describe() == (
        "servo bus: write 1 bytes at register 0x39 (present position, high byte) of servo 3: 01 "
        "(or a status with errors)"
    )


def test_sync_read_of_an_impossible_servo_names_no_servos(codec: Codec) -> None:
    packet = only(codec, noise.servo_packet(bytes.fromhex("FE 05 82 38 02 FE")))
    assert isinstance(packet, ServoPacket)
    assert (packet.instruction, packet.servos, packet.register) == ("sync read", (), None)


def test_starts_are_the_header_and_each_id_of_the_table() -> None:
    frame = servo_bus().table.frame
    for id in range(256):
        matches = re.match(STARTS, frame.header + bytes([id]), re.DOTALL) is not None
        assert matches == (id in frame.addresses)
    for size in range(1, len(frame.header) + 1):
        assert re.match(STARTS, frame.header[:size], re.DOTALL)


@given(
    st.one_of(
        field.servo_packets(),
        st.binary(max_size=12).map(lambda rest: b"\xff\xff" + rest),
        st.binary(max_size=260).map(lambda body: noise.servo_packet(body)[: len(body) + 3]),
    ),
    st.integers(0, 300),
)
def test_size_equals_the_size_that_plain_rules_give(data: bytes, cut: int) -> None:
    for part in (data, data[:cut], data * 2):
        assert packet_size(part, 0) == _plain_size(part)


def _plain_size(packet: bytes) -> int | None:
    if not packet or not packet.startswith(b"\xff\xff"[: len(packet)]):
        return 0
    if (len(packet) > 2 and packet[2] == 0xFF) or (len(packet) > 3 and packet[3] < 2):
        return 0
    # The spec limits the data of a status packet to 252 bytes; only instructions can have LEN 255.
    if packet[3:4] == b"\xff" and len(packet) > 4 and packet[4] not in (3, 4, 0x82, 0x83):
        return 0
    if len(packet) < 4 or len(packet) < 4 + packet[3]:
        return None
    end = 4 + packet[3]
    return end if (sum(packet[2 : end - 1]) + packet[end - 1]) % 256 == 255 else 0
