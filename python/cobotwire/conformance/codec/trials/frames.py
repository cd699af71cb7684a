"""Trials of single messages: values to bytes and back, and what must be refused."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.codec.reference.check import check
from cobotwire.conformance.codec.named import encode_named, plain_fields
from cobotwire.conformance.codec.trials.pictures import (
    Picture,
    case_of,
    illegal_pictures,
    named_values,
    ordinary,
    pictures,
    wire_data,
)
from cobotwire.conformance.codec.trials.trial import Json, Trial
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.table import Command, Direction, Field, Layout, Number, Table

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


class Form(NamedTuple):
    """One form of one message; ``label`` names it among the trials."""

    command: Command
    direction: Direction
    layout: Layout
    label: str


def forms_of(table: Table) -> Iterator[Form]:
    """Every form of every framed message of an edition."""
    for command in table.commands:
        for direction in DIRECTIONS:
            layouts = command.layouts(direction)
            for index, layout in enumerate(layouts):
                form = f".{index + 1}" if len(layouts) > 1 else ""
                yield Form(command, direction, layout, f"{command.name}/{direction}{form}")


def frame_of(table: Table, id: int, data: bytes) -> bytes:
    """A whole frame around data bytes, legal or not."""
    frame = table.frame
    body = frame.header + bytes(frame.addresses[:1]) + bytes([frame.length(len(data)), id]) + data
    return body + check(frame, body)


def ordinary_frame(table: Table, form: Form, turn: int = 0) -> bytes:
    """The frame of a form with ordinary values."""
    return frame_of(
        table, form.command.id, wire_data(form.layout, ordinary(form.layout, turn=turn))
    )


def encoding(codec: Codec) -> Iterator[Trial]:
    """Values that must become bytes: legal ones, their corners, and those between two steps."""
    for form in forms_of(codec.table):
        for picture in pictures(form.layout):
            values = named_values(form.layout, picture.wholes)
            yield _encode(codec, form, picture.name, values)
        for name, values in _between_steps(form):
            yield _encode(codec, form, name, values)


def refusing_values(codec: Codec) -> Iterator[Trial]:
    """Values that must be refused before they become bytes, though the wire could carry most."""
    for form in forms_of(codec.table):
        for picture, _, _ in illegal_pictures(form.layout):
            yield _encode(codec, form, picture.name, named_values(form.layout, picture.wholes))
        for name, values in _wrong_counts(form):
            yield _encode(codec, form, name, values)


def _encode(codec: Codec, form: Form, name: str, values: Json) -> Trial:
    command, direction = form.command.name, form.direction
    ask = {"do": "encode", "direction": direction, "command": command, "fields": values}
    try:
        expect: Json = {"bytes": hexed(encode_named(codec, command, direction, values))}
        rule = "encode-bytes"
    except UsageError as error:
        expect, rule = {"refused": "bad-value", "why": str(error)}, "encode-refuses"
    return Trial(f"{rule}/{form.label}/{name}", rule, command, ask, expect)


def _between_steps(form: Form) -> Iterator[tuple[str, Json]]:
    """Nearest step, ties to the even one; and the bounds hold after rounding."""
    base = ordinary(form.layout)
    values = named_values(form.layout, base)
    for field in form.layout.fields:
        case = case_of(form.layout, field, base)
        assert case is not None, "an ordinary selector has a case"
        number = case.numbers[0]
        if not number.scaled or field.choices:
            continue
        for steps in _fractions(number):
            value: Any = steps * number.multiply / number.divide
            if field.many:
                value = [value, *values[field.name][1:]]
            yield f"{field.name}={steps}-steps", {**values, field.name: value}


def _fractions(number: Number) -> list[float]:
    low, high = number.minimum, number.maximum
    wished = [0.4, 0.6, -0.4, -0.6, 1.5, 2.5, -1.5, -2.5, 28.999999999999996, 100.3]
    return [steps for steps in wished if low <= steps <= high] + [high + 0.4, low - 0.4]


def _wrong_counts(form: Form) -> Iterator[tuple[str, Json]]:
    values = named_values(form.layout, ordinary(form.layout))
    for field in _rows(form.layout):
        row = values[field.name]
        yield f"{field.name}-one-short", {**values, field.name: row[:-1]}
        yield f"{field.name}-one-more", {**values, field.name: [*row, row[-1]]}


def _rows(layout: Layout) -> list[Field]:
    return [field for field in layout.fields if field.many]


def decoding(codec: Codec) -> Iterator[Trial]:
    """Frames that must be read: legal ones and their corners."""
    for form in forms_of(codec.table):
        for picture in pictures(form.layout):
            yield _of_picture(codec, form, picture)


def refusing_numbers(codec: Codec) -> Iterator[Trial]:
    """Frames that hold a number which the edition does not allow."""
    for form in forms_of(codec.table):
        for picture, _, _ in illegal_pictures(form.layout):
            yield _of_picture(codec, form, picture)


def _of_picture(codec: Codec, form: Form, picture: Picture) -> Trial:
    data = frame_of(codec.table, form.command.id, wire_data(form.layout, picture.wholes))
    return decode(codec, form.direction, form.command.name, f"{form.label}/{picture.name}", data)


def decode(codec: Codec, direction: Direction, of: str, name: str, data: bytes) -> Trial:
    """The trial of some bytes as a message; ``of`` names the command that it must be, if any."""
    ask: Json = {"do": "decode", "direction": direction, "bytes": hexed(data)}
    if of:
        ask["command"] = of
    try:
        message = codec.decode(direction, data, of=of or None)
        expect: Json = {"command": message.command.name, "fields": plain_fields(message)}
        rule = "decode-values"
    except ProtocolError as error:
        expect = {"refused": error.reason, "offset": error.offset, "why": str(error)}
        rule = "decode-refuses"
    return Trial(f"{rule}/{name}", rule, of, ask, expect)


def hexed(data: bytes) -> str:
    """Bytes as the protocol writes them."""
    return data.hex().upper()
