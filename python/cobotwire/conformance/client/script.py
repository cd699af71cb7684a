"""What the client was told to send, beside what came: then scale, sign and order are judged."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.conformance.client.past import Heard
from cobotwire.session.device import Asked, Malformed
from cobotwire.table import Command, Layout, Number

RULES: dict[str, str] = {
    "sent-scale": "values are sent in the scale of their field",
    "sent-sign": "values are sent with their sign",
    "sent-byte-order": "words are sent in the byte order of their field",
    "sent-order": "values are sent in the order of the fields",
    "sent-rounded": "values are sent as the nearest step",
    "sent-value": "values are sent as they were told",
    "sent-form": "requests are sent in the form that was told",
    "sent-once": "an order that was told once is sent once",
    "sent-all": "all that was told is sent",
    "sent-nothing-else": "nothing is sent that was not told",
}
_SCALES = (10, 100, 1000, 57.29577951308232)


class Told(NamedTuple):
    """A line of the script; ``place`` is where it stands."""

    command: Command
    values: tuple[Any, ...]
    place: str


class Finding(NamedTuple):
    """A rule of this file that was broken."""

    rule: str
    command: str
    reason: str


class Script:
    """Follows what comes through the lines of a script."""

    def __init__(self, codec: Codec, told: Sequence[Told]) -> None:
        """Take the script.

        Raises:
            UsageError: a line cannot be said in this edition.
        """
        self._codec = codec
        self._told = list(told)
        self._frames = [codec.encode(t.command.name, "request", t.values) for t in told]
        self._at = 0
        # What was taken for the line before: if it was wrong, it may come again as it was.
        self._taken = b""

    def hear(self, heard: Heard) -> Iterator[Finding]:
        """Judge a frame."""
        if not isinstance(heard.event, Asked | Malformed):
            return
        data = heard.data
        if self._at < len(self._frames) and data == self._frames[self._at]:
            self._at += 1
        elif self._at and data in (self._taken, self._frames[self._at - 1]):
            yield from self._again()
            return
        elif self._at < len(self._frames) and self._same_id(data):
            told = self._told[self._at]
            rule, reason = differs(self._codec, told, self._frames[self._at], data)
            self._at += 1
            yield Finding(rule, told.command.name, f"{told.place}: {reason}")
        else:
            yield from self._elsewhere(heard)
        self._taken = data

    def _same_id(self, data: bytes) -> bool:
        at = self._codec.table.frame.overhead
        return data[at] == self._frames[self._at][at] and data not in self._frames[self._at :]

    def _again(self) -> Iterator[Finding]:
        """A query may be asked again: a reply that came may have been lost on the way."""
        told = self._told[self._at - 1]
        if told.command.safety != "query":
            yield Finding("sent-once", told.command.name, f"{told.place}: it came once more")

    def _elsewhere(self, heard: Heard) -> Iterator[Finding]:
        """It is a later line, or none at all."""
        rest = self._frames[self._at :]
        if heard.data in rest:
            behind = self._at + rest.index(heard.data)
            yield from self._missing(behind)
            self._at = behind + 1
            return
        name = heard.command.name if heard.command is not None else ""
        yield Finding("sent-nothing-else", name, f"{heard.data.hex(' ').upper()} is in no line")

    def end(self) -> Iterator[Finding]:
        """Nothing more comes."""
        yield from self._missing(len(self._told))
        self._at = len(self._told)

    def _missing(self, behind: int) -> Iterator[Finding]:
        for told in self._told[self._at : behind]:
            yield Finding("sent-all", told.command.name, f"{told.place}: it never came")


def differs(codec: Codec, told: Told, right: bytes, given: bytes) -> tuple[str, str]:
    """Which rule a frame of the right command breaks, and how."""
    if len(right) != len(given):
        wanted = f"expected {right.hex(' ').upper()}, got {given.hex(' ').upper()}"
        return "sent-form", wanted
    numbers = _numbers(codec, told, right)
    pairs = [
        (name, number, right[at : at + number.width], given[at : at + number.width])
        for name, number, at in numbers
    ]
    wrong = [pair for pair in pairs if pair[2] != pair[3]]
    if not wrong:
        return "sent-value", f"expected {right.hex(' ').upper()}, got {given.hex(' ').upper()}"
    name, number, a, b = wrong[0]
    expected, got = _whole(number, a), _whole(number, b)
    words = f"{name}: expected {_value(number, expected)}, got {_value(number, got)}"
    if all(pair[3] == pair[2][::-1] for pair in wrong):
        return "sent-byte-order", f"{words}, its bytes exchanged"
    if len(wrong) > 1 and sorted(p[2] for p in wrong) == sorted(p[3] for p in wrong):
        return "sent-order", f"{words}, which is another value's place"
    return _of_number(expected, got), words


def _of_number(expected: int, got: int) -> str:
    if got == -expected:
        return "sent-sign"
    if abs(got - expected) == 1:
        return "sent-rounded"
    for scale in _SCALES:
        for factor in (scale, 1 / scale, -scale, -1 / scale):
            if got and abs(expected * factor - got) <= 1:
                return "sent-scale"
    return "sent-value"


def _numbers(codec: Codec, told: Told, frame: bytes) -> list[tuple[str, Number, int]]:
    """Every number of the form that was told, with its name and its place in the frame."""
    message = codec.decode("request", frame, of=told.command.name)
    found: list[tuple[str, Number, int]] = []
    at = codec.table.frame.overhead + 1
    for index, field in enumerate(message.layout.fields):
        for element, number in enumerate(_case(message.layout, index, message.values)):
            part = f".{number.name or element}" if field.many else ""
            found.append((field.name + part, number, at))
            at += number.width
    return found


def _case(layout: Layout, index: int, values: Sequence[Any]) -> tuple[Number, ...]:
    field = layout.fields[index]
    if field.selector < 0:
        return field.cases[0].numbers
    picked = int(values[field.selector])
    return next(case.numbers for case in field.cases if picked in case.when)


def _whole(number: Number, data: bytes) -> int:
    word = int.from_bytes(data, number.order)
    return word - 256**number.width if word > number.signed_at else word


def _value(number: Number, whole: int) -> str:
    value = whole * number.multiply / number.divide if number.scaled else whole
    return f"{value:g} {number.unit}".rstrip()
