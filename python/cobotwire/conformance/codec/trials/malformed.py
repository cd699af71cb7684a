"""Trials of bytes that are no legal frame, and of those that several commands share."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.codec.interface import Codec
from cobotwire.conformance.codec.trials.frames import (
    DIRECTIONS,
    Form,
    decode,
    forms_of,
    frame_of,
    ordinary_frame,
)
from cobotwire.conformance.codec.trials.trial import Trial
from cobotwire.table import Table


def malformed(codec: Codec) -> Iterator[Trial]:
    """Each message with a wrong byte in each place that is not data, cut short, and too long."""
    for form in forms_of(codec.table):
        for name, data in damages(codec.table, ordinary_frame(codec.table, form)):
            place = f"{form.label}/{name}"
            yield decode(codec, form.direction, form.command.name, place, data)


def damages(table: Table, whole: bytes) -> Iterator[tuple[str, bytes]]:
    """The ways in which a frame can be broken, but for its values."""
    at, end = table.frame.length_at, len(whole) - table.frame.check_size
    for index in range(len(table.frame.header)):
        yield f"header-{index}", _with(whole, index, whole[index] ^ 1)
    for step in (-2, -1, 1, 2):
        yield f"length{step:+d}", _with(whole, at, (whole[at] + step) & 0xFF)
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
    if table.frame.addresses:
        yield "address", _with(whole, at - 1, _none_of(table.frame.addresses))


def _none_of(taken: tuple[int, ...]) -> int:
    return next(byte for byte in range(256) if byte not in taken)


def _with(data: bytes, index: int, byte: int) -> bytes:
    return data[:index] + bytes([byte]) + data[index + 1 :]


def every_id(codec: Codec) -> Iterator[Trial]:
    """Every id in both directions, with no data and with one byte: most are not legal."""
    for direction in DIRECTIONS:
        for id in range(256):
            for data in (b"", b"\x01", bytes(12)):
                place = f"any/{direction}/id-{id:02X}-data-{len(data)}"
                yield decode(codec, direction, "", place, frame_of(codec.table, id, data))


def shared(codec: Codec) -> Iterator[Trial]:
    """Each message, read by somebody who does not know whose it is."""
    for form in forms_of(codec.table):
        for turn in (0, 7):
            data = ordinary_frame(codec.table, form, turn)
            yield decode(codec, form.direction, "", f"any/{form.label}/unnamed-{turn}", data)


def of_another(codec: Codec) -> Iterator[Trial]:
    """Each message, offered as that of a command with another id: it must not be taken."""
    forms = list(forms_of(codec.table))
    for form in forms:
        other = next(o for o in forms if _stranger(form, o))
        data = ordinary_frame(codec.table, form)
        place = f"{form.label}/as-{other.command.name}"
        yield decode(codec, form.direction, other.command.name, place, data)


def _stranger(form: Form, other: Form) -> bool:
    return other.direction == form.direction and other.command.id != form.command.id
