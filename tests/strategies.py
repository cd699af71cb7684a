"""Every Hypothesis strategy, made from an edition's own table; left out: from ``mycobot``'s."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

from hypothesis import strategies as st

import line
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.table import Case, Command, Direction, Field, Layout, Number, Table

TABLES = {table.edition: table for table in (TABLE, TABLE_280)}


class Form(NamedTuple):
    """One form of one message; ``number`` tells it from the command's others."""

    command: Command
    direction: Direction
    layout: Layout
    number: int


def forms_of(table: Table) -> list[Form]:
    """Every form of every message of an edition."""
    return [
        Form(command, direction, layout, index)
        for command in table.commands
        for direction in ("request", "reply")
        for index, layout in enumerate(command.layouts(direction))
    ]


FORMS = forms_of(TABLE)


@lru_cache
def codec_of(edition: str, name: codecs.CodecName) -> Codec:
    """One codec of an edition, made once."""
    return codecs.load(TABLES[edition], name)


def forms(table: Table = TABLE) -> st.SearchStrategy[Form]:
    """Any form of any message of the edition."""
    return st.sampled_from(FORMS if table is TABLE else forms_of(table))


def _whole(field: Field, number: Number) -> st.SearchStrategy[int]:
    if field.choices:
        return st.sampled_from(field.choices)
    return st.integers(number.minimum, number.maximum)


def _value(field: Field, number: Number) -> st.SearchStrategy[Any]:
    whole = _whole(field, number)
    if field.kind == "flag":
        return whole.map(bool)
    if number.scaled:
        return whole.map(lambda steps: steps * number.multiply / number.divide)
    return whole


def _of_case(field: Field, case: Case) -> st.SearchStrategy[Any]:
    elements = [_value(field, number) for number in case.numbers]
    return st.tuples(*elements) if field.many else elements[0]


@st.composite
def legal_values(draw: st.DrawFn, layout: Layout) -> tuple[Any, ...]:
    """Values that the layout allows, each on a step of its scale."""
    values: list[Any] = [
        draw(_of_case(field, field.cases[0])) if field.selector < 0 else None
        for field in layout.fields
    ]
    for index, field in enumerate(layout.fields):
        if field.selector >= 0:
            picked = values[field.selector]
            case = next(case for case in field.cases if picked in case.when)
            values[index] = draw(_of_case(field, case))
    return tuple(values)


def messages(table: Table = TABLE) -> st.SearchStrategy[tuple[Form, tuple[Any, ...]]]:
    """Any legal message: its form and its values."""
    return forms(table).flatmap(lambda form: st.tuples(st.just(form), legal_values(form.layout)))


def odd_values() -> st.SearchStrategy[Any]:
    """Values of all kinds, most of which no field allows."""
    scalars = st.one_of(
        st.floats(),
        st.integers(),
        st.integers(-70_000, 70_000),
        st.floats(-700, 700),
        st.booleans(),
        st.none(),
        st.text(max_size=3),
        st.binary(max_size=3),
        st.fractions(),
        st.decimals(allow_nan=True),
        st.complex_numbers(),
    )
    rows = st.lists(st.one_of(st.floats(-700, 700), scalars), max_size=8)
    return st.one_of(scalars, rows, rows.map(tuple), st.dictionaries(st.text(max_size=1), scalars))


@st.composite
def any_arguments(draw: st.DrawFn, table: Table = TABLE) -> tuple[str, Direction, tuple[Any, ...]]:
    """A message with values of which some, or all, or none, are allowed."""
    form, values = draw(messages(table))
    spoilt = [draw(odd_values()) if draw(st.integers(0, 3)) == 0 else value for value in values]
    if draw(st.integers(0, 9)) == 0:
        spoilt.append(draw(odd_values()))
    return form.command.name, form.direction, tuple(spoilt)


def near_frames(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """What looks like a frame for some bytes, and is none or is one by chance."""
    longest = table.frame.maximum_length
    lengths = st.integers(0, longest + 4)
    ids = st.sampled_from([command.id for command in table.commands]) | st.integers(0, 255)
    return st.builds(
        lambda length, id, rest: table.frame.header + bytes([length, id]) + rest,
        lengths,
        ids,
        st.binary(max_size=longest + 2),
    )


def real_frames(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """A legal frame, built by the reference codec."""
    codec = codec_of(table.edition, "reference")
    return messages(table).map(lambda message: frame_of(codec, *message))


def frame_of(codec: Codec, form: Form, values: tuple[Any, ...]) -> bytes:
    """The frame of a message, in just that form."""
    return codec.encode(form.command.name, form.direction, values, form=form.number)


def line_noise(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """Noise as a line carries it: servo packets, text, NULs, half headers, and anything."""
    return line.line_noise(table)


def received(table: Table, listening: Listening) -> st.SearchStrategy[line.Received]:
    """Frames of what is listened to as they come in over a bad line, and which came whole."""
    codec = codec_of(table.edition, "reference")
    heard = [form for form in forms_of(table) if listening in (form.direction, "both")]
    frames = (
        st.sampled_from(heard)
        .flatmap(lambda form: st.tuples(st.just(form), legal_values(form.layout)))
        .map(lambda message: frame_of(codec, *message))
    )
    return line.received(frames, table)


def streams(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """What may stand on a line: frames, near frames and noise in any order."""
    pieces = st.one_of(real_frames(table), near_frames(table), line_noise(table))
    return st.lists(pieces, max_size=8).map(b"".join)


@st.composite
def chunked(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """``data`` in pieces, some of them empty."""
    cuts = sorted(draw(st.lists(st.integers(0, len(data)), max_size=10)))
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)])]
