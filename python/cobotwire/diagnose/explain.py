"""Say what each byte of a frame means, or why bytes are not a legal frame."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import groupby
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.addresses import address_name
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.rejection import element_name
from cobotwire.protocol.table import Direction, Field, Number, Table

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
# A polled arm repeats itself: the readings of this many different frames are kept.
REMEMBERED = 4096


class Part(NamedTuple):
    """A run of bytes inside a frame, and what it means; ``raw`` is the raw value of a number."""

    offset: int
    data: bytes
    name: str
    meaning: str
    raw: int | None = None


class Reading(NamedTuple):
    """One way to read a frame: as a message, or the reason why it cannot be read this way."""

    direction: Direction
    message: DecodedMessage | None
    error: ProtocolError | None


class FrameReader:
    """Reads frames in each direction that they fit; remembers the last readings."""

    def __init__(self, codec: Codec, directions: tuple[Direction, ...] = DIRECTIONS) -> None:
        self._codec, self._directions = codec, directions
        self._indexes = [FrameIndex(codec.table, direction) for direction in directions]
        self.read = lru_cache(REMEMBERED)(self._read)

    def _read(self, data: bytes) -> tuple[Reading, ...]:
        """Return the messages that ``data`` can be; if there are none, each direction's reason.

        Bytes that do not start with the header of a frame have no readings.
        """
        frame = self._codec.table.frame
        if not data.startswith(frame.header):
            return ()
        heading = frame.read_id(data), frame.read_length(data)
        complete = len(data) >= frame.head_size
        fitting = [i.direction for i in self._indexes if complete and i.find(*heading)]
        found = tuple(self._read_as(d, data) for d in fitting or self._directions)
        messages = tuple(reading for reading in found if reading.message is not None)
        # A bad value in one direction explains more than a LEN that does not fit the other.
        bad_values = tuple(
            r for r in found if r.error is not None and r.error.reason == "bad-value"
        )
        return messages or bad_values or found

    def _read_as(self, direction: Direction, data: bytes) -> Reading:
        try:
            return Reading(direction, self._codec.decode(direction, data), None)
        except ProtocolError as error:
            return Reading(direction, None, error)


def frame_parts(table: Table, data: bytes, message: DecodedMessage) -> Iterator[Part]:
    """Yield every byte of a legal frame with its meaning, in order."""
    frame = table.frame
    yield Part(0, data[: len(frame.header)], "header", "a frame starts here")
    yield from sorted(_fixed_parts(table, data, message))
    offset = frame.data_start(message.direction)
    for field, value in zip(message.variant.fields, message.values):
        if field.kind in ("bytes", "text"):
            size = field.size
            yield Part(offset, data[offset : offset + size], field.name, format_bytes(value))
            offset += size
            continue
        for at, (number, single) in enumerate(_numbers(message, field, value)):
            name = element_name(field, number, at)
            # If several numbers share bytes, the bytes are shown with the last of them.
            chunk = data[offset : offset + number.step]
            raw = number.unpack(data, offset)
            yield Part(offset, chunk, name, format_value(field, number, single), raw)
            offset += number.step
    end = "footer" if frame.check is None else "check"
    yield Part(offset, data[offset:], end, "the frame ends here")


def _fixed_parts(table: Table, data: bytes, message: DecodedMessage) -> Iterator[Part]:
    frame = table.frame
    if frame.address_at is not None and message.address is not None:
        at = frame.address_at
        yield Part(at, data[at : at + 1], "address", address_name(table, message.address))
    length, at = frame.read_length(data), frame.length_at
    follow = at + frame.length_number.width == frame.overhead
    meaning = f"{length}: {length} bytes follow" if follow else str(length)
    yield Part(at, data[at : at + frame.length_number.width], "LEN", meaning)
    if frame.has_id(message.direction):
        command, at = message.command, frame.id_at
        id = data[at : at + frame.id_number.width]
        yield Part(at, id, "CMD", f"{command.name}: {command.title}")


def _numbers(message: DecodedMessage, field: Field, value: Any) -> Iterator[tuple[Number, Any]]:
    case = message.variant.case(field, message.values)
    yield from zip(case.numbers, field.flatten(value, len(case.numbers)))


def format_value(field: Field, number: Number, value: Any) -> str:
    """Return one value with its unit or label."""
    if "flag" in (field.kind, number.kind):
        return "yes" if value else "no"
    if field.labels:
        return f"{field.labels[field.choices.index(value)]} ({value})"
    if number.labels:
        return f"{number.labels[number.choices.index(value)]} ({value})"
    unit = f" {number.units}" if number.unit else ""
    return f"{value:g}{unit}" if isinstance(value, float) else f"{value}{unit}"


def format_bytes(value: Any) -> str:
    """Return bytes as hex digits, and texts in quotes."""
    if isinstance(value, bytes):
        return value.hex(" ").upper() or "no bytes"
    return repr(value)


def format_message(message: DecodedMessage) -> str:
    """Return a message on one line: a request like a call, a reply with an arrow before it."""
    values = []
    for field, value in zip(message.variant.fields, message.values):
        numbers = list(_numbers(message, field, value))
        if field.kind in ("bytes", "text"):
            text = format_bytes(value)
        elif not field.many:
            text = format_value(field, *numbers[0])
        elif numbers and numbers[0][0].bits:
            text = _format_bits(field, numbers)
        else:
            text = _format_tuple(numbers)
        values.append(f"{field.name}={text}")
    arrow = "" if message.direction == "request" else "-> "
    way = "to" if message.direction == "request" else "from"
    device = "" if message.address is None else f" {way} address {message.address}"
    return f"{arrow}{message.command.name}({', '.join(values)}){device}"


def _format_bits(field: Field, numbers: list[tuple[Number, Any]]) -> str:
    """Return the named numbers of a bit field; a flag only if it is set: ``(ready, level=5)``."""
    parts = [
        number.name if number.kind == "flag" else f"{number.name}={format_value(field, number, v)}"
        for number, v in numbers
        if v or number.kind != "flag"
    ]
    return f"({', '.join(parts)})"


def _format_tuple(numbers: list[tuple[Number, Any]]) -> str:
    """Return a tuple that names each unit once: ``(0, 0, 50 millimetres; 0, 0, 0 degrees)``."""
    groups = []
    for unit, group in groupby(numbers, key=lambda pair: pair[0].units):
        values = ", ".join(f"{value:g}" for _, value in group)
        groups.append(f"{values} {unit}".strip())
    return f"({'; '.join(groups)})"
