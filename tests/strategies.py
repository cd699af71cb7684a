"""Hypothesis strategies made from an edition's table, by default from that of ``mycobot``."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from importlib import import_module
from typing import Any, NamedTuple

from hypothesis import strategies as st

import noisy_lines
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.table import Case, Command, Direction, Field, Number, Table, Variant

TABLES = {table.edition: table for table in (TABLE, TABLE_280)}
CODECS: tuple[codecs.CodecName, ...] = ("reference", "native")
DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


class CommandVariant(NamedTuple):
    """One variant of one message; ``number`` is its index among the command's variants."""

    command: Command
    direction: Direction
    variant: Variant
    number: int


def variants_of(table: Table) -> list[CommandVariant]:
    """Return every variant of every message of an edition."""
    return [
        CommandVariant(command, direction, variant, index)
        for command in table.commands
        for direction in DIRECTIONS
        for index, variant in enumerate(command.variants(direction))
    ]


VARIANTS = variants_of(TABLE)


@lru_cache
def codec_of(edition: str, name: codecs.CodecName) -> Codec:
    """Return a codec of an edition, cached."""
    table = import_module(f"cobotwire.editions.{edition}").TABLE
    return codecs.load(table, name)


def variants(table: Table = TABLE) -> st.SearchStrategy[CommandVariant]:
    """Draw any variant of any message of the edition."""
    return _sampled(VARIANTS if table is TABLE else variants_of(table))


def _sampled(variants: Sequence[CommandVariant]) -> st.SearchStrategy[CommandVariant]:
    """Draw one of the variants. Hypothesis would hash all of them each time, which takes long."""
    return st.sampled_from(range(len(variants))).map(lambda index: variants[index])


def _with_values(
    variant: CommandVariant,
) -> st.SearchStrategy[tuple[CommandVariant, tuple[Any, ...]]]:
    return legal_values(variant.variant).map(lambda values: (variant, values))


def _raw(field: Field, number: Number) -> st.SearchStrategy[int]:
    if choices := field.choices or number.choices:
        return st.sampled_from(choices)
    return st.integers(number.minimum, number.maximum)


def _value(field: Field, number: Number) -> st.SearchStrategy[Any]:
    raw = _raw(field, number)
    return raw.map(bool) if field.kind == "flag" else raw.map(number.physical)


def _of_case(field: Field, case: Case) -> st.SearchStrategy[Any]:
    elements = [_value(field, number) for number in case.numbers]
    return st.tuples(*elements) if field.many else elements[0]


@st.composite
def legal_values(draw: st.DrawFn, variant: Variant) -> tuple[Any, ...]:
    """Draw values that the variant allows, each on a step of its scale."""
    values: list[Any] = [
        draw(_of_case(field, field.cases[0])) if field.selector < 0 else None
        for field in variant.fields
    ]
    for index, field in enumerate(variant.fields):
        if field.selector >= 0:
            values[index] = draw(_of_case(field, variant.case(field, values)))
    return tuple(values)


def messages(table: Table = TABLE) -> st.SearchStrategy[tuple[CommandVariant, tuple[Any, ...]]]:
    """Draw any legal message: its variant and its values."""
    return variants(table).flatmap(_with_values)


def odd_values() -> st.SearchStrategy[Any]:
    """Draw values of all kinds; no field allows most of them."""
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
    """Draw a message with any mixture of legal and illegal values."""
    variant, values = draw(messages(table))
    mixed = [draw(odd_values()) if draw(st.integers(0, 3)) == 0 else value for value in values]
    if draw(st.integers(0, 9)) == 0:
        mixed.append(draw(odd_values()))
    return variant.command.name, variant.direction, tuple(mixed)


def near_frames(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """Draw bytes that begin like a frame, and are a legal frame only by chance."""
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
    """Draw a legal frame, built by the reference codec."""
    codec = codecs.load(table, "reference")
    addresses = st.sampled_from(table.frame.addresses or (None,))
    return st.builds(
        lambda message, address: frame_of(codec, message[0], message[1], address),
        messages(table),
        addresses,
    )


def frame_of(
    codec: Codec, variant: CommandVariant, values: tuple[Any, ...], address: int | None = None
) -> bytes:
    """Return the frame of a message in exactly this variant."""
    name, direction, index = variant.command.name, variant.direction, variant.number
    return codec.encode(name, direction, values, variant=index, address=address)


def line_noise(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """Draw realistic noise: servo packets, text, NULs, half headers, and any bytes."""
    return noisy_lines.line_noise(table)


def received(table: Table, listening: Listening) -> st.SearchStrategy[noisy_lines.Received]:
    """Draw frames received over a bad line, and which of them arrive undamaged."""
    codec = codecs.load(table, "reference")
    expected = [
        variant for variant in variants_of(table) if listening in (variant.direction, "both")
    ]
    frames = _sampled(expected).flatmap(_with_values).map(lambda message: frame_of(codec, *message))
    return noisy_lines.received(frames, table)


def streams(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """Draw the bytes of a line: frames, near frames and noise in any order."""
    pieces = st.one_of(real_frames(table), near_frames(table), line_noise(table))
    return st.lists(pieces, max_size=8).map(b"".join)


@st.composite
def chunked(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """Draw ``data`` cut into pieces, some of them empty."""
    cuts = sorted(draw(st.lists(st.integers(0, len(data)), max_size=10)))
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)])]
