"""Define the data bytes of a message: fields and variants, and the rules to read them.

A *raw value* is a number as it is on the wire, after its sign rule. A *physical value* is the same
number in units.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, Literal, NamedTuple

from cobotwire.protocol.arguments import Row
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.numbers import Number

FieldKind = Literal["number", "flag", "enum", "bytes", "text"]
# The raw values of a message, by field and element.
RawRows = Sequence[Sequence[int]]


class Case(NamedTuple):
    """The numbers of a field if its selector is one of ``when``; ``()`` if it has no selector."""

    when: tuple[int, ...]
    numbers: tuple[Number, ...]


class Field(NamedTuple):
    """One argument of a request, or one value of a reply.

    ``many`` fields are tuples with one element for each number. ``choices`` lists all legal raw
    values (``()``: every value between minimum and maximum); ``labels`` names them for people.
    If ``selector`` is not -1, it is the index of another field of the variant: the raw value of
    that field picks the case. All cases of a field take the same number of bytes.

    ``const`` is the only raw value of a constant, which is no argument and no result. ``default``
    are the raw values of an argument that the caller leaves out.

    A field of ``bytes`` or ``text`` has a number for each byte. ``encoding`` is the encoding of a
    text, and ``padding`` the byte after a text that is shorter than its field (-1: none). If
    ``each`` is not 0, the value is a tuple of elements of that many numbers: tuples, or texts.
    ``sizes`` are the smallest and the largest length of a list whose length varies; each variant
    has one of the lengths. A field that ``counts`` the elements of
    another one has the same ``sizes``; callers pass ``...`` for it. ``meanings`` describe ranges of
    raw values, each with its first and last; other values are legal too.
    """

    name: str
    kind: FieldKind
    cases: tuple[Case, ...]
    doc: str
    many: bool = False
    choices: tuple[int, ...] = ()
    labels: tuple[str, ...] = ()
    selector: int = -1
    echo: bool = False
    const: int | None = None
    default: tuple[int, ...] | None = None
    each: int = 0
    encoding: str = ""
    padding: int = -1
    sizes: tuple[int, int] | None = None
    counts: str = ""
    meanings: tuple[tuple[int, int, str], ...] = ()

    def meaning(self, raw: int) -> str:
        """Return what a raw value stands for; empty if the edition does not say."""
        for low, high, text in self.meanings:
            if low <= raw <= high:
                return text.replace("{number}", str(raw))
        return ""

    @property
    def size(self) -> int:
        """The number of bytes on the wire."""
        numbers = self.cases[0].numbers
        return len(numbers) if self.kind in ("bytes", "text") else packed_size(numbers)

    @property
    def dimensions(self) -> tuple[int, ...]:
        """The shape of the field's numbers in one message; a list of groups has two dimensions."""
        count = len(self.cases[0].numbers)
        if not self.many:
            return ()
        return (count // self.each, self.each) if self.each else (count,)

    @property
    def numbers(self) -> tuple[Number, ...]:
        """The numbers of all cases."""
        return tuple(number for case in self.cases for number in case.numbers)

    @property
    def raw_range(self) -> tuple[int, int]:
        """The lowest and the highest raw value that the field allows in any case."""
        numbers = self.numbers
        return (
            min(self.choices or [number.minimum for number in numbers], default=0),
            max(self.choices or [number.maximum for number in numbers], default=0),
        )

    def case(self, selected: int | None) -> Case | None:
        """Return the case that applies while the selector holds the raw value ``selected``.

        A field without a selector has one case, which always applies. Return None if no case
        applies.
        """
        if self.selector < 0:
            return self.cases[0]
        for case in self.cases:
            if selected in case.when:
                return case
        return None

    def allows(self, number: Number, raw: int) -> bool:
        """Return whether one of the field's numbers may hold a raw value."""
        if self.choices:
            return raw in self.choices
        return number.allows(raw)

    def present(self, values: Sequence[Any]) -> Any:
        """Return the value of the field from the values of its numbers, which are legal."""
        if not self.many:
            return values[0]
        if self.kind == "bytes":
            return bytes(values)
        groups = [values[at : at + self.each] for at in range(0, len(values), self.each or 1)]
        if self.kind == "text":
            return tuple(map(self.text, groups)) if self.each else self.text(values)
        return tuple(map(tuple, groups)) if self.each else tuple(values)

    def text(self, values: Sequence[int]) -> str:
        """Return one text from its bytes, without padding."""
        data = bytes(values)
        if self.padding >= 0:
            data = data.rstrip(bytes([self.padding]))
        return data.decode(self.encoding)

    def bad_text_at(self, values: Sequence[Any]) -> int | None:
        """Return the index of the first byte that is not text, or None."""
        if self.kind != "text" or self.encoding != "utf-8":
            return None
        for at in range(0, len(values), self.each or len(values) or 1):
            try:
                bytes(values[at : at + (self.each or len(values))]).decode()
            except UnicodeDecodeError as error:
                return at + error.start
        return None

    def flatten(self, value: Any, size: int) -> list[Any]:
        """Return the values of the ``size`` numbers that make up a legal value of the field."""
        if not self.many:
            return [value]
        if self.kind != "text":
            return [part for group in value for part in group] if self.each else list(value)
        texts, each = (value, self.each) if self.each else ((value,), size)
        pad = bytes([max(self.padding, 0)])
        return [byte for text in texts for byte in text.encode(self.encoding).ljust(each, pad)]

    def physical(self, raw: Sequence[int]) -> Any:
        """Return the value of a field without a selector that holds these raw values."""
        values = [n.physical(each) for n, each in zip(self.cases[0].numbers, raw)]
        if self.many:
            return self.present(values)
        return bool(values[0]) if self.kind == "flag" and self.const is None else values[0]

    def meets(self, number: Number, other: Field, other_number: Number) -> bool:
        """Return whether a raw value is legal in a number of this field and in one of another."""
        ends = ((self, number, other, other_number), (other, other_number, self, number))
        for one, here, two, there in ends:
            if choices := one.choices or here.choices:
                return any(two.allows(there, raw) for raw in choices)
        lowest = max(number.minimum, other_number.minimum)
        return lowest <= min(number.maximum, other_number.maximum)


class _VariantFields(NamedTuple):
    fields: tuple[Field, ...]


class Variant(_VariantFields):
    """The data bytes of one variant of a message: its ``fields``."""

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names of the fields; every decoded message needs them."""
        return tuple([field.name for field in self.fields])

    @property
    def size(self) -> int:
        """The number of data bytes on the wire, without header, LEN, command id and check."""
        return sum([field.size for field in self.fields])

    @property
    def row(self) -> Row:
        """The variant as :mod:`cobotwire.protocol.arguments` describes it."""
        return tuple(
            [
                ...
                if field.counts
                else field.physical([field.const])
                if field.const is not None
                else field.name
                if field.default is None
                else (field.name, field.physical(field.default))
                for field in self.fields
            ]
        )

    def case(self, field: Field, values: Sequence[Any]) -> Case:
        """Return the case of a field in a message with these physical values.

        Raises:
            UsageError: no case applies to the value of the selector.
        """
        if field.selector < 0:
            return field.cases[0]
        value = values[field.selector]
        selector = self.fields[field.selector].cases[0].numbers[0]
        case = field.case(selector.raw(value))
        if case is None:
            raise self._unselected(field, value)
        return case

    def raw_case(self, field: Field, rows: RawRows) -> Case | None:
        """Return the case of a field in a message with these raw values; None if none applies."""
        return field.case(None if field.selector < 0 else rows[field.selector][0])

    def excludes(self, other: Variant) -> bool:
        """Return whether no data bytes are legal in both variants.

        That is certain if their sizes differ, or if two numbers at the same offset, such as two
        constants, have no raw value in common.
        """
        if self.size != other.size:
            return True
        others = other.by_offset()
        return any(
            number.alike(others[offset][1]) and not field.meets(number, *others[offset])
            for offset, (field, number) in self.by_offset().items()
            if offset in others
        )

    def by_offset(self) -> dict[int, tuple[Field, Number]]:
        """Return the fields and numbers that no selector decides, by their offset."""
        found: dict[int, tuple[Field, Number]] = {}
        for index, field in enumerate(self.fields):
            at = self.start(index)
            for number in field.cases[0].numbers if field.selector < 0 else ():
                found[at] = field, number
                at += number.step
        return found

    def start(self, index: int) -> int:
        """Return the offset of the field at ``index`` in the data bytes."""
        return sum([field.size for field in self.fields[:index]])

    def unpack(self, data: bytes) -> list[tuple[int, ...]]:
        """Return the raw values in the data bytes of a message, a tuple for each field.

        Raises:
            UsageError: no case of a field applies to the value of its selector.
        """
        rows: list[tuple[int, ...]] = []
        for index, field in enumerate(self.fields):
            at, row = self.start(index), []
            for number in self._case_in(field, data).numbers:
                row.append(number.unpack(data, at))
                at += number.step
            rows.append(tuple(row))
        return rows

    def pack(self, rows: RawRows) -> bytes:
        """Return the data bytes of raw values, whether or not the fields allow them.

        If no case of a field applies, its first case is used.
        """
        return b"".join(
            [
                pack_numbers((self.raw_case(field, rows) or field.cases[0]).numbers, row)
                for field, row in zip(self.fields, rows)
            ]
        )

    def _case_in(self, field: Field, data: bytes) -> Case:
        if field.selector < 0:
            return field.cases[0]
        number = self.fields[field.selector].cases[0].numbers[0]
        selected = number.unpack(data, self.start(field.selector))
        case = field.case(selected)
        if case is None:
            raise self._unselected(field, selected)
        return case

    def _unselected(self, field: Field, selected: Any) -> UsageError:
        legal = ", ".join([str(when) for case in field.cases for when in case.when])
        return UsageError(self.fields[field.selector].name, selected, f"one of {legal}")


def named_fields(variants: tuple[Variant, ...]) -> dict[str, list[Field]]:
    """Return the fields by name, without constants; those of the longest variant come first."""
    found: dict[str, list[Field]] = {}
    for variant in sorted(variants, key=lambda variant: len(variant.fields), reverse=True):
        for field in variant.fields:
            if field.const is None:
                found.setdefault(field.name, []).append(field)
    return found


def packed_size(numbers: Sequence[Number]) -> int:
    """Return the number of bytes of consecutive numbers."""
    return sum([number.step for number in numbers])


def pack_numbers(numbers: Sequence[Number], row: Sequence[int]) -> bytes:
    """Return the bytes of the raw values of consecutive numbers; unnamed bits are 0."""
    packed, shared = [], 0
    for number, raw in zip(numbers, row):
        data = number.pack(raw)
        if number.more or shared:
            shared |= int.from_bytes(data, number.order)
            data = shared.to_bytes(number.width, number.order)
        if not number.more:
            packed.append(data)
            shared = 0
    return b"".join(packed)
