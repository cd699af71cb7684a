"""Draw legal messages of any table as raw values, whatever their types."""

from __future__ import annotations

from typing import NamedTuple

from hypothesis import strategies as st

from cobotwire.protocol.numbers import raw_of_float
from cobotwire.protocol.table import Case, Command, Direction, Field, Number, Table, Variant
from strategies import CommandVariant, variants_of

TEXTS = st.sampled_from(["", "a", "é", "€uro", "𝄞", "abc def", "\0", "~"])


class RawMessage(NamedTuple):
    """A message with its raw values, a row for each field, and its frame."""

    variant: CommandVariant
    rows: list[tuple[int, ...]]
    frame: bytes

    def __repr__(self) -> str:
        """Leave out the command and its variants, whose text is very long."""
        place = f"{self.command.name}, {self.direction}, {self.variant.number}"
        return f"RawMessage({place}, {self.rows}, {self.frame.hex(' ')})"

    @property
    def command(self) -> Command:
        """The command of the message."""
        return self.variant.command

    @property
    def direction(self) -> Direction:
        """The direction of the message."""
        return self.variant.direction


@st.composite
def raw_messages(draw: st.DrawFn, table: Table) -> RawMessage:
    """Draw a legal message of any variant, with any address."""
    # Draw an index: Hypothesis hashes the values it samples from, and these records are large.
    found = variants_of(table)
    variant = found[draw(st.integers(0, len(found) - 1))]
    rows = draw(raw_rows(variant.variant))
    address = draw(st.sampled_from(table.frame.addresses or (None,)))
    data = variant.variant.pack(rows)
    frame = table.frame.enclose(variant.command.id, data, address, variant.direction)
    return RawMessage(variant, rows, frame)


@st.composite
def raw_rows(draw: st.DrawFn, variant: Variant) -> list[tuple[int, ...]]:
    """Draw legal raw values for each field of a variant."""
    rows: list[tuple[int, ...]] = [
        draw(_row(field, field.cases[0])) if field.selector < 0 else () for field in variant.fields
    ]
    for index, field in enumerate(variant.fields):
        if field.selector >= 0:
            case = variant.raw_case(field, rows)
            assert case is not None, "the selector is legal"
            rows[index] = draw(_row(field, case))
    return rows


def _row(field: Field, case: Case) -> st.SearchStrategy[tuple[int, ...]]:
    if field.kind == "text":
        size = len(case.numbers)
        each = field.each or size or 1
        texts = st.lists(_text(field, each), min_size=size // each, max_size=size // each)
        return texts.map(lambda found: tuple(b"".join(found)))
    if field.kind == "bytes":
        size = len(case.numbers)
        return st.binary(min_size=size, max_size=size).map(tuple)
    return st.tuples(*[_raw(field, number) for number in case.numbers])


def _text(field: Field, size: int) -> st.SearchStrategy[bytes]:
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
