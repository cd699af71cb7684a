"""Say what the dissector must show of a message that the Python codec has decoded."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import DecodedMessage
from cobotwire.protocol.table import Field, Number
from cobotwire_codegen.render.words import units
from targets.wireshark.dissecting import Leaf

_NOTES = re.compile(r" \[-?\d+ on the wire\]| \[echo of the request\]$")


class Expected(NamedTuple):
    """A leaf of the tree: the last part of its filter, its value, its bytes, and its label.

    Without a label, the label is not compared: Wireshark writes that of masked bits.
    """

    name: str
    value: Any
    data: bytes
    label: str
    digits: int = 15

    def difference(self, leaf: Leaf) -> str:
        """Return how a leaf differs; empty if it does not."""
        shown = re.sub(r"_(text|bytes|number)?$", "", leaf.filter).split(".")[-1]
        label = _NOTES.sub("", leaf.label)
        same = (shown, leaf.data) == (self.name, self.data) and self._same_value(leaf.value)
        if same and (label == self.label or label.endswith(f"= {self.label}")):
            return ""
        return f"{self.name}: {leaf} differs from {self}"

    def _same_value(self, shown: str) -> bool:
        if isinstance(self.value, str):
            # Wireshark escapes what cannot be printed.
            return shown == self.value or not self.value.isprintable()
        if isinstance(self.value, bytes):
            return shown == self.value.hex(":")
        # A boolean is 1 or 0; later versions of Wireshark write a word.
        number = float({"True": "1", "False": "0"}.get(shown, shown))
        right = float(f"{self.value:.{self.digits}g}")
        return number == right or (math.isnan(number) and math.isnan(right))


def expected_leaves(message: DecodedMessage, data: bytes) -> Iterator[Expected]:
    """Yield what is shown of each number and text, from the data bytes of a message."""
    variant, at = message.variant, 0
    for field, row in zip(variant.fields, variant.unpack(data)):
        case = variant.case(field, message.values)
        if field.kind in ("bytes", "text"):
            yield from _strings(field, data[at : at + field.size])
        else:
            yield from _numbers(field, case.numbers, row, data[at : at + field.size])
        at += field.size


def _strings(field: Field, data: bytes) -> Iterator[Expected]:
    if field.kind == "bytes":
        # Wireshark cuts the words of long bytes, not their value.
        words = data[:36].hex() + "…" * (len(data) > 36) if data else "<MISSING>"
        yield Expected(field.name, data, data, f"{field.name}: {words}")
        return
    if not field.each:
        text = field.present(list(data))
        yield Expected(field.name, text, data, f"{field.name}: {_quoted(text)}")
        return
    for index, text in enumerate(field.present(list(data))):
        part = data[index * field.each : (index + 1) * field.each]
        yield Expected(field.name, text, part, f"{field.name}[{index}]: {_quoted(text)}")


def _quoted(text: str) -> str:
    escaped = re.sub(r'[\0-\x1f\x7f"\\]', lambda found: f"\\x{ord(found[0]):02x}", text)
    return f'"{escaped}"'


def _numbers(
    field: Field, numbers: Sequence[Number], row: Sequence[int], data: bytes
) -> Iterator[Expected]:
    at, listed = 0, _is_list(field)
    for index, (number, raw) in enumerate(zip(numbers, row)):
        value, name = number.physical(raw), number.name or field.name
        title = f"{name}[{index}]" if listed and not number.name else name
        # Wireshark shows 15 digits of a double, and the editions' values have no more.
        digits = 6 if (number.encoding, number.width) == ("float", 4) else 15
        label = f"{title}: {_words(field, number, raw, value)}"
        yield Expected(name, value, data[at : at + number.width], label, digits)
        at += number.step


def _is_list(field: Field) -> bool:
    """Return whether a field is a list of numbers without names."""
    return field.many and not any(number.name for number in field.numbers)


def _words(field: Field, number: Number, raw: int, value: float) -> str:
    labels, choices = (
        (number.labels, number.choices) if number.bits else (field.labels, field.choices)
    )
    if labels:
        return f"{labels[choices.index(raw)]} ({raw})"
    if number.bits and number.kind == "flag":
        return "True" if raw else "False"
    if field.kind == "flag":
        return "yes" if raw else "no"
    unit = f" {units(number.unit)}" if number.unit else ""
    meaning = f" ({field.meaning(raw)})" if field.meaning(raw) else ""
    return _digits(number, value) + unit + meaning


def _digits(number: Number, value: float) -> str:
    if math.isnan(value):
        return "nan"
    if number.encoding == "float" and number.width == 4:
        packed = struct.pack("f", value)
        for digits in (6, 7, 8):
            near = float(f"{value:.{digits}g}")
            if abs(near) < 3.4e38 and abs(near - value) <= abs(value) / 2**25:
                assert struct.pack("f", near) == packed, "few digits are another float"
                return f"{value:.{digits}g}"
        return f"{value:.9g}" if math.isfinite(value) else f"{value:.15g}"
    return f"{value:.15g}"
