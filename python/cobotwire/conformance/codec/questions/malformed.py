"""Questions about bytes that are not a legal frame, and about ids that several commands share."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.codec.interface import Codec
from cobotwire.conformance.codec.questions.frames import (
    DECODE_REJECTS,
    DECODE_VALUES,
    DIRECTIONS,
    REJECTION_REASON,
    decode,
    frame_of,
    ordinary_frame,
    variants_of,
)
from cobotwire.conformance.codec.questions.question import Question
from cobotwire.conformance.suite import Group
from cobotwire.protocol.table import Table


def _damaged(codec: Codec) -> Iterator[Question]:
    """Yield each message with a wrong byte outside its data; also too short and too long."""
    for variant in variants_of(codec.table):
        for name, data in damages(codec.table, ordinary_frame(codec.table, variant)):
            place = f"{variant.label}/{name}"
            yield decode(codec, variant.direction, variant.command.name, place, data)


def damages(table: Table, whole: bytes) -> Iterator[tuple[str, bytes]]:
    """Yield the ways in which a frame can be broken, except for its values."""
    frame, end = table.frame, len(whole) - table.frame.check_size
    for index in range(len(table.frame.header)):
        yield f"header-{index}", _with(whole, index, whole[index] ^ 1)
    for step in (-2, -1, 1, 2):
        yield f"length{step:+d}", frame.with_length(whole, frame.read_length(whole) + step)
    for index in range(end, len(whole)):
        for byte in (whole[index] ^ 1, 0, 0xFE, 0xFF):
            if byte != whole[index]:
                yield f"check-{index - end}-{byte:02X}", _with(whole, index, byte)
    for size in range(len(whole)):
        yield f"cut-at-{size}", whole[:size]
    yield "one-more", whole + b"\x00"
    yield "footer-twice", whole + whole[-1:]
    yield "twice", whole + whole
    yield "byte-in-front", b"\x00" + whole
    yield "header-byte-in-front", whole[:1] + whole
    others = (byte for byte in range(256) if byte not in frame.addresses)
    if frame.address_at is not None and (other := next(others, None)) is not None:
        yield "address", _with(whole, frame.address_at, other)


def _with(data: bytes, index: int, byte: int) -> bytes:
    return data[:index] + bytes([byte]) + data[index + 1 :]


def _every_id(codec: Codec) -> Iterator[Question]:
    """Yield every id in both directions, with and without data: most are not legal."""
    for direction in DIRECTIONS:
        for id in range(256):
            for data in (b"", b"\x01", bytes(12)):
                place = f"any/{direction}/id-{id:02X}-data-{len(data)}"
                yield decode(codec, direction, "", place, frame_of(codec.table, id, data))


def _shared_ids(codec: Codec) -> Iterator[Question]:
    """Yield calls that decode each message without naming its command."""
    for variant in variants_of(codec.table):
        for turn in (0, 7):
            data = ordinary_frame(codec.table, variant, turn)
            yield decode(codec, variant.direction, "", f"any/{variant.label}/unnamed-{turn}", data)


def _other_commands(codec: Codec) -> Iterator[Question]:
    """Yield calls that name a command with another id: the message must be rejected."""
    variants = list(variants_of(codec.table))
    for variant in variants:
        direction, id = variant.direction, variant.command.id
        other = next(o for o in variants if o.direction == direction and o.command.id != id)
        data = ordinary_frame(codec.table, variant)
        name = other.command.name
        yield decode(codec, direction, name, f"{variant.label}/as-{name}", data)


REJECTS = (DECODE_REJECTS, REJECTION_REASON)
DAMAGED = Group(
    "damaged frames",
    REJECTS,
    _damaged,
    sends="Frames with a wrong byte outside their data, frames cut short, and frames too long.",
    subject="each variant of each message",
)
EVERY_ID = Group(
    "every id",
    (DECODE_VALUES, *REJECTS),
    _every_id,
    sends="Frames with every id, with and without data.",
    subject="both directions",
)
SHARED_IDS = Group(
    "shared ids",
    (DECODE_VALUES, *REJECTS),
    _shared_ids,
    sends="Calls that decode a frame without naming its command.",
    subject="each variant of each message",
)
OTHER_COMMANDS = Group(
    "other commands",
    REJECTS,
    _other_commands,
    sends="Calls that decode a frame and name another command.",
    subject="each variant of each message",
)
