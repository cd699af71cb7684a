"""Turn the types of an ``edition.json`` into the numbers and fields of a table."""

from __future__ import annotations

from typing import Any

from cobotwire.protocol.table import Field, FieldKind, Number

Record = dict[str, Any]
BYTE = Number("", 1, "big", 255, 1, 1, 0, 255, "")
ASCII = Number("", 1, "big", 255, 1, 1, 0, 127, "")
# The kinds of fields, by the kinds of their types; the others are numbers.
FIELD_KINDS: dict[str, FieldKind] = {
    "flag": "flag",
    "enum": "enum",
    "bytes": "bytes",
    "text": "text",
}
# The kinds of types with several numbers, besides lists.
MANY = ("value", "bits", "bytes", "text")


class TypeRecords:
    """The types of a document, by name; each is converted once."""

    def __init__(self, wires: list[Record], types: list[Record]) -> None:
        self._wires = {wire["name"]: wire for wire in wires}
        self._records = {type["name"]: _prepared(type) for type in types}
        self._fields: dict[str, Field] = {}
        self._numbers: dict[str, tuple[Number, ...]] = {}

    def record(self, reference: str | Record) -> Record:
        """Return the record of a type that is given by its name, or as a record."""
        if isinstance(reference, str):
            return self._records[reference]
        return reference if "numbers" in reference else _prepared(reference)

    def field(self, reference: str | Record) -> Field:
        """Return a field of a type, without what the message decides: a name, cases, a constant."""
        if isinstance(reference, str) and reference in self._fields:
            return self._fields[reference]
        type = self.record(reference)
        least, most = type.get("least", 1), type.get("most", 1)
        if type["kind"] == "list":
            of = self.field(type["of"])
            each = len(self.numbers_of(type["of"])) if of.many else 0
            field = of._replace(many=True, each=each, meanings=())
        else:
            field = Field(
                "",
                FIELD_KINDS.get(type["kind"], "number"),
                (),
                "",
                type["kind"] in MANY,
                choices_of(type),
                tuple([member["name"] for member in type.get("members", ())]),
                encoding=type.get("encoding", ""),
                padding=type.get("padding", -1),
                meanings=type["meanings"],
            )
        field = field._replace(sizes=(least, most) if least < most else None)
        if isinstance(reference, str):
            self._fields[reference] = field
        return field

    def numbers_of(self, reference: str | Record, count: int | None = None) -> tuple[Number, ...]:
        """Return a type's numbers in wire order, for ``count`` elements or the fewest allowed."""
        type = self.record(reference)
        least: int = type.get("least", 1)
        return self._element(reference, type) * (least if count is None else count)

    def _element(self, reference: str | Record, type: Record) -> tuple[Number, ...]:
        """Return the numbers of one element of a list, or all numbers of another type."""
        if isinstance(reference, str) and reference in self._numbers:
            return self._numbers[reference]
        kind = type["kind"]
        if kind == "value":
            numbers = tuple(
                [self._number(item["name"], self.record(item["type"])) for item in type["items"]]
            )
        elif kind == "list":
            numbers = self.numbers_of(type["of"])
        elif kind == "bits":
            numbers = type["numbers"]
        elif kind in ("bytes", "text"):
            numbers = (ASCII if type.get("encoding") == "ascii" else BYTE,)
        else:
            numbers = (self._number("", type),)
        if isinstance(reference, str):
            self._numbers[reference] = numbers
        return numbers

    def _number(self, name: str, type: Record) -> Number:
        wire = type["wire"]
        if isinstance(wire, str):
            wire = self._wires[wire]
        get = type.get
        multiply, _, divide = str(get("scale", 1)).partition("/")
        number = Number(
            name,
            wire["width"],
            wire["order"],
            wire["signed_at"],
            int(multiply),
            int(divide or 1),
            0,
            0,
            get("unit", ""),
            wire.get("encoding", "integer"),
            choices=tuple(get("choices", ())),
        )
        if listed := choices_of(type):
            low, high = min(listed), max(listed)
        else:
            # A bound that is left out allows every raw value, but of floats only the finite ones.
            low, high = number.raw_range
            low, high = get("minimum", low), get("maximum", high)
        return number._replace(minimum=low, maximum=high)


def _prepared(type: Record) -> Record:
    """Convert the lists of a type once, not for each field of each variant."""
    type["meanings"] = tuple([*map(_meaning, type.get("meanings", ()))])
    type["numbers"] = tuple([_bits(number) for number in type.get("numbers", ())])
    return type


def _meaning(record: Record) -> tuple[int, int, str]:
    return record["first"], record["last"], record["says"]


def choices_of(type: Record) -> tuple[int, ...]:
    """Return all legal raw values of a type; empty if it has a range."""
    if type["kind"] == "flag":
        return 0, 1
    return tuple([member["value"] for member in type.get("members", ())] or type.get("choices", ()))


def _bits(record: Record) -> Number:
    """Return a number that occupies some bits of its bytes."""
    lists = {name: tuple(record[name]) for name in ("choices", "labels")}
    return Number(**{**record, **lists})
