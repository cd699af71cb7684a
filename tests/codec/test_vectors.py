"""Both codecs encode and decode the vectors of every edition's spec."""

from __future__ import annotations

from typing import Any

import pytest

import json_tables
import vectors
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction
from cobotwire_codegen.model import Vector
from strategies import codec_of

EACH_EDITION = pytest.mark.parametrize("edition", vectors.editions())


def _of(edition: str) -> list[Vector]:
    """Return the vectors of an edition, of which there is at least one."""
    found = vectors.edition(edition).vectors
    assert found
    return list(found)


def test_all_examples_of_the_document_are_vectors() -> None:
    numbers = [vector.example for vector in vectors.edition().vectors if vector.example]
    assert numbers == list(range(1, 89))


@EACH_EDITION
def test_stated_values_encode_to_the_frame_and_the_frame_decodes_to_them(
    codec: Codec, edition: str
) -> None:
    codec = codec_of(edition, codec.name)
    for vector in _of(edition):
        if vector.frame is None:
            continue
        fields = vectors.fields(edition, vector)
        address = codec.table.frame.address(vector.frame)
        values = tuple(fields.values())
        frame = codec.encode(vector.command, vector.direction, values, address=address)
        assert frame == vector.frame, vector.name
        message = codec.decode(vector.direction, vector.frame, of=vector.command)
        assert message.command.name == vector.command
        assert message.fields == fields, vector.name


@EACH_EDITION
def test_codec_accepts_and_refuses_the_stated_values(codec: Codec, edition: str) -> None:
    codec = codec_of(edition, codec.name)
    for vector in _of(edition):
        for fields, legal in vectors.limits(edition, vector):
            try:
                codec.encode(vector.command, vector.direction, tuple(fields.values()))
            except UsageError:
                assert not legal, (vector.name, fields)
            else:
                assert legal, (vector.name, fields)


def test_five_examples_have_an_illegal_length_in_both_directions(codec: Codec) -> None:
    def legal(printed: bytes, direction: Direction) -> bool:
        try:
            codec.decode(direction, printed)
        except ProtocolError:
            return False
        return True

    illegal = [
        vector.example
        for vector in vectors.edition().vectors
        if vector.printed
        and not (legal(vector.printed, "request") or legal(vector.printed, "reply"))
    ]
    assert illegal == [26, 32, 37, 74, 75]
    # Example 57 prints a reply in place of a request, so it is rejected as a request, too.
    rejected = [vector.example for vector in vectors.edition().vectors if vector.rejected]
    assert rejected == [26, 32, 37, 57, 74, 75]


@EACH_EDITION
def test_illegal_length_is_rejected_with_its_reason(codec: Codec, edition: str) -> None:
    for vector in _of(edition):
        if vector.rejected is None:
            continue
        assert vector.printed is not None
        with pytest.raises(ProtocolError, match="LEN") as caught:
            codec_of(edition, codec.name).decode(vector.direction, vector.printed)
        assert (caught.value.reason, caught.value.offset) == vector.rejected, vector.name
        assert caught.value.data == vector.printed


BLOCK = (0xFEFEFEFE,) * 31
# Features that no edition has; the frames of "crc" are those of a real arm.
SAMPLES: list[tuple[str, str, Direction, str, tuple[Any, ...]]] = [
    ("sample", "get_angles", "request", "FEFE0220FA", ()),
    (
        *("sample", "get_angles", "reply", "FEFE0E20FEFE001D80E880E900002328FA"),
        ((-2.58, 0.29, 330.0, -325.35, 0, 90),),
    ),
    (
        *("sample", "send_angles", "request", "FEFE0F2200640000000000000000FF9C32FA"),
        ((1, 0, 0, 0, 0, -1), 50),
    ),
    (
        *("sample", "in_position", "request", "FEFE0F2A00640000000000000000000000FA"),
        ((1, 0, 0, 0, 0, 0), 0),
    ),
    (
        *("sample", "in_position", "request", "FEFE0F2A000A0000000000640000000001FA"),
        ((1, 0, 0, 1, 0, 0), 1),
    ),
    ("sample", "in_position", "reply", "FEFE032A01FA", (True,)),
    ("sample", "is_servo_on", "reply", "FEFE04500300FA", (3, False)),
    ("sample", "is_servo_on", "reply", "FEFE035001FA", (True,)),
    ("sample", "get_ticks", "reply", "FEFE0660FEFFFFFFFA", (-2,)),
    ("long", "get_memory", "reply", "FEFEFE30" + 253 * "FA", ((0xFAFAFAFA,) * 63,)),
    ("long", "get_part", "reply", "FEFE7E31" + 124 * "00" + "FA", ((0,) * 31,)),
    ("long", "get_part", "reply", "FEFE8031" + 126 * "FE" + "FA", (BLOCK, (0xFE, 0xFE))),
    (
        *("long", "get_kinds", "reply", "FEFE1633" + 10 * "FF" + "FEFFFFFF010000FFFFFEFA"),
        (255, -1, 65535, -1, 0xFFFFFFFF, -2, 1, -2),
    ),
    (
        *("long", "get_edges", "reply", "FEFE183400FF0100FF80FF7F00FF0000FFFF000100007FFFFFFFFA"),
        (255, 256, -128, -129, 255, 65535, 65536, 0x7FFFFFFF),
    ),
    (
        *("long", "get_scaled", "reply", "FEFE103501FFFF00010002FFFF00000006FFFA"),
        (1 / 3, (-0.1, 0.01, 0.002), -3 / 7, -0.7, -10),
    ),
    ("alike", "jog", "request", "FEFE036119FA", (25,)),
    ("alike", "set_right", "request", "FEFE04600205FA", (2, 5)),
    ("crc", "set_free_mode", "request", "FEFE045801FD87", (1,)),
    ("crc", "set_free_mode", "reply", "FEFE0558FF013E3D", (255, 1)),
    ("crc", "get_robot_status", "request", "FEFE036E20D1", ()),
    ("crc", "get_robot_status", "reply", "FEFE046E009D51", (0,)),
    ("crc", "set_break", "reply", "FEFE054DFF01FA2C", (255, 1)),
    ("crc", "set_speed", "reply", "FEFE064C03F90CD43D", (3, (-1780,))),
    ("crc", "motion_end", "reply", "FEFE045B010D87", (1,)),
    ("sum", "power_on", "request", "FEFE01021010", ()),
]


@pytest.mark.parametrize(("table", "command", "direction", "frame", "values"), SAMPLES)
def test_values_of_sample_encode_to_frame_and_frame_decodes_to_them(
    codec: Codec,
    table: str,
    command: str,
    direction: Direction,
    frame: str,
    values: tuple[Any, ...],
) -> None:
    codec, data = json_tables.codec_of(table, codec.name), bytes.fromhex(frame)
    assert codec.encode(command, direction, values) == data
    assert tuple(codec.decode(direction, data, of=command).fields.values()) == values
