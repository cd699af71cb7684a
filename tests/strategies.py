"""Hypothesis strategies made from an edition's table, by default from that of ``mycobot``.

They are cached, because Hypothesis validates each new strategy.
"""

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
from cobotwire.protocol.numbers import raw_of_float
from cobotwire.protocol.table import Case, Command, Direction, Field, Number, Table, Variant

TABLES = {table.edition: table for table in (TABLE, TABLE_280)}
CODECS: tuple[codecs.CodecName, ...] = ("reference", "native")
DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
TEXTS = st.sampled_from(["", "a", "é", "€uro", "𝄞", "abc def", "\0", "~"])


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


@lru_cache
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


@st.composite
def raw_rows(draw: st.DrawFn, variant: Variant) -> list[tuple[int, ...]]:
    """Draw legal raw values for each field of a variant."""
    rows: list[tuple[int, ...]] = [
        draw(_row(field, field.cases[0])) if field.selector < 0 else () for field in variant.fields
    ]
    for index, field in enumerate(variant.fields):
        if field.selector >= 0:
            rows[index] = draw(_row(field, _case(variant, field, rows)))
    return rows


def _case(variant: Variant, field: Field, rows: list[tuple[int, ...]]) -> Case:
    """Return the case that a selector picks; the selector of a random table may pick none."""
    return variant.raw_case(field, rows) or field.cases[0]


def _row(field: Field, case: Case) -> st.SearchStrategy[tuple[int, ...]]:
    if field.kind == "text":
        size = len(case.numbers)
        each = field.each or size or 1
        texts = st.lists(_characters(field, each), min_size=size // each, max_size=size // each)
        return texts.map(lambda found: tuple(b"".join(found)))
    if field.kind == "bytes":
        size = len(case.numbers)
        return st.binary(min_size=size, max_size=size).map(tuple)
    return st.tuples(*[_raw(field, number) for number in case.numbers])


def _characters(field: Field, size: int) -> st.SearchStrategy[bytes]:
    """Draw whole characters that fill exactly ``size`` bytes."""

    def fitted(text: str) -> bytes:
        found = b""
        for letter in text:
            data = letter.encode(field.encoding, errors="ignore")
            found += data if len(found) + len(data) <= size else b""
        return found.ljust(size, bytes([field.padding]) if field.padding >= 0 else b"x")

    return st.lists(TEXTS, max_size=size).map("".join).map(fitted)


def _raw(field: Field, number: Number) -> st.SearchStrategy[int]:
    if field.choices or number.choices:
        return st.sampled_from(field.choices or number.choices)
    if number.encoding == "float":
        low, high = number.raw_range
        ends = st.sampled_from([number.minimum, number.maximum, 0, -1])
        finite = st.integers(max(number.minimum, low), min(number.maximum, high))
        nan = raw_of_float(float("nan"), number.width)
        usual = ends.filter(lambda raw: low <= raw <= high or not number.takes_not_finite)
        beyond = st.sampled_from([nan, low - 1, high + 1]) if number.takes_not_finite else usual
        return finite | usual | beyond
    return st.integers(number.minimum, number.maximum)


@st.composite
def legal_values(draw: st.DrawFn, variant: Variant) -> tuple[Any, ...]:
    """Draw values that the variant allows, each on a step of its scale."""
    rows = draw(raw_rows(variant))
    return tuple(_value(variant, field, rows) for field in variant.fields)


def _value(variant: Variant, field: Field, rows: list[tuple[int, ...]]) -> Any:
    case, row = _case(variant, field, rows), rows[variant.fields.index(field)]
    if field.kind in ("flag", "text", "bytes"):
        return field.present([bool(raw) for raw in row] if field.kind == "flag" else list(row))
    return field.present([number.physical(raw) for number, raw in zip(case.numbers, row)])


@lru_cache
def messages(table: Table = TABLE) -> st.SearchStrategy[tuple[CommandVariant, tuple[Any, ...]]]:
    """Draw any legal message: its variant and its values."""
    return variants(table).flatmap(_with_values)


@lru_cache
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


@lru_cache
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


@lru_cache
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


@lru_cache
def line_noise(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """Draw realistic noise: servo packets, text, NULs, half headers, and any bytes."""
    return noisy_lines.line_noise(table)


@lru_cache
def received(table: Table, listening: Listening) -> st.SearchStrategy[noisy_lines.Received]:
    """Draw frames received over a bad line, and which of them arrive undamaged."""
    codec = codecs.load(table, "reference")
    expected = [
        variant for variant in variants_of(table) if listening in (variant.direction, "both")
    ]
    frames = _sampled(expected).flatmap(_with_values).map(lambda message: frame_of(codec, *message))
    return noisy_lines.received(frames, table)


@lru_cache
def streams(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """Draw the bytes of a line: frames, near frames and noise in any order."""
    pieces = st.one_of(real_frames(table), near_frames(table), line_noise(table))
    return st.lists(pieces, max_size=8).map(b"".join)


@st.composite
def chunked(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """Draw ``data`` cut into pieces, some of them empty."""
    cuts = sorted(draw(st.lists(st.integers(0, len(data)), max_size=10)))
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)])]
