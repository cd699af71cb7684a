"""Turn the types of an ``edition.json`` into the numbers of a table."""

from __future__ import annotations

from math import inf
from typing import Any

from cobotwire.protocol.numbers import raw_of_float
from cobotwire.protocol.table import Number

Record = dict[str, Any]
BYTE = Number("", 1, "big", 255, 1, 1, 0, 255, "")
ASCII = Number("", 1, "big", 255, 1, 1, 0, 127, "")


class TypeRecords:
    """The types of a document, by name; each is converted once."""

    def __init__(self, wires: list[Record], types: list[Record]) -> None:
        self._wires = {wire["name"]: wire for wire in wires}
        self._records = {type["name"]: _prepared(type) for type in types}
        self._numbers: dict[str, tuple[Number, ...]] = {}

    def record(self, reference: str | Record) -> Record:
        """Return the record of a type that is given by its name, or as a record."""
        if isinstance(reference, str):
            return self._records[reference]
        return reference if "numbers" in reference else _prepared(reference)

    def numbers_of(self, reference: str | Record) -> tuple[Number, ...]:
        """Return a type's numbers in the order of the wire."""
        if isinstance(reference, str) and reference in self._numbers:
            return self._numbers[reference]
        type = self.record(reference)
        if type["kind"] == "value":
            numbers = tuple(
                [self._number(item["name"], self.record(item["type"])) for item in type["items"]]
            )
        else:
            numbers = (self._number("", type),)
        if isinstance(reference, str):
            self._numbers[reference] = numbers
        return numbers

    def _number(self, name: str, type: Record) -> Number:
        wire = type["wire"]
        if isinstance(wire, str):
            wire = self._wires[wire]
        top = 256 ** wire["width"]
        signed_at, get = wire["signed_at"], type.get
        encoding = wire.get("encoding", "integer")
        low, high = (signed_at + 1 - top if signed_at < top - 1 else 0), signed_at
        if encoding == "float":
            # A bound that is left out allows all finite floats.
            high = raw_of_float(inf, wire["width"]) - 1
            low = -1 - high
        kind = type["kind"]
        if kind == "flag":
            low, high = 0, 1
        elif listed := choices_of(type):
            low, high = min(listed), max(listed)
        else:
            low, high = get("minimum", low), get("maximum", high)
        multiply, _, divide = str(get("scale", 1)).partition("/")
        return Number(
            name,
            wire["width"],
            wire["order"],
            signed_at,
            int(multiply),
            int(divide or 1),
            low,
            high,
            get("unit", ""),
            encoding,
            choices=tuple(get("choices", ())),
        )


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
    """Return a number that is some bits of a word."""
    lists = {name: tuple(record[name]) for name in ("choices", "labels")}
    return Number(**{**record, **lists})


def letters_of(type: Record) -> tuple[Number, ...]:
    """Return the number of a byte of text."""
    return (ASCII if type["encoding"] == "ascii" else BYTE,)
