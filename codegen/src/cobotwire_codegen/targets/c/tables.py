"""Builds the tables that the C codec interprets; equal runs are stored once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cobotwire_codegen import lower
from cobotwire_codegen.model import Edition, Field
from cobotwire_codegen.targets.c.messages import DIRECTIONS, Member, Message, messages
from cobotwire_codegen.targets.c.names import bits, integer, string

CONSTANT = 0xFF
NO_SELECTOR = 0xFF


class Pool:
    """An array of rows that stores equal runs once."""

    def __init__(self) -> None:
        self.rows: list[str] = []

    def place(self, run: Sequence[str]) -> int:
        """Return where the run starts in the array; append it if it is missing."""
        wanted = list(run)
        for start in range(len(self.rows) - len(wanted) + 1):
            if self.rows[start : start + len(wanted)] == wanted:
                return start
        self.rows += wanted
        return len(self.rows) - len(wanted)


class Tables:
    """The arrays of one edition, each as the text of its elements."""

    def __init__(self, edition: Edition) -> None:
        self.messages = messages(edition)
        self.raw_bits = 64 if any(map(_wide, _numbers(self.messages))) else 32
        self.numbers, self.raw_values, self.cases, self.fields = Pool(), Pool(), Pool(), Pool()
        self.rows = [self._message(message) for message in self.messages]
        self.lengths = {way: self._lengths(edition, way) for way in DIRECTIONS}
        self.most = max((message.count for message in self.messages), default=0)
        self.most_fields = max((len(message.members) for message in self.messages), default=0)
        self.names = [string(message.command.name) for message in self.messages]
        self.field_names = [_row(_names(message)) for message in self.messages]

    def _lengths(self, edition: Edition, direction: str) -> list[str]:
        overhead = 1 + edition.frame.check_size
        own = [message for message in self.messages if message.direction == direction]
        return bits([message.size + overhead for message in own])

    def _message(self, message: Message) -> str:
        variant = tuple(member.field for member in message.members)
        fields = [self._field(member, variant) for member in message.members]
        place = self.fields.place(fields)
        direction = message.direction.upper()
        return (
            f"{{{place}, 0x{message.command.id:02X}, {direction}, {message.size}, {len(fields)}}}"
        )

    def _field(self, member: Member, variant: tuple[Field, ...]) -> str:
        field = member.field
        cases = [self._case(when, lower.numbers(type)) for when, type in lower.cases(field)]
        selector = lower.selector(field, variant)
        choices = _choices(field)
        parts = [
            self.cases.place(cases),
            self.raw_values.place([integer(choice) for choice in choices]),
            len(cases),
            len(choices),
            NO_SELECTOR if selector < 0 else selector,
            member.index if member.count else CONSTANT,
        ]
        return "{" + ", ".join(map(str, parts)) + "}"

    def _case(self, when: tuple[int, ...], numbers: tuple[dict[str, Any], ...]) -> str:
        picked = self.raw_values.place([integer(value) for value in when])
        return (
            f"{{{picked}, {self.numbers.place([_number(number) for number in numbers])}, "
            f"{len(when)}, {len(numbers)}}}"
        )


def _names(message: Message) -> list[str]:
    return [string(member.field.name) for member in message.members] or ['""']


def _row(parts: list[str]) -> str:
    return "{" + ", ".join(parts) + "}"


def _choices(field: Field) -> tuple[int, ...]:
    """Return the closed list; empty if the bounds allow the same values."""
    choices = lower.field_choices(field)
    if (
        field.const is None
        and len(set(choices)) == max(choices, default=0) - min(choices, default=1) + 1
    ):
        return ()
    return choices


def _number(number: dict[str, Any]) -> str:
    little = "1" if number["order"] == "little" else "0"
    low, high = integer(number["minimum"]), integer(number["maximum"])
    return f"{{{number['signed_at']}, {low}, {high}, {number['width']}, {little}}}"


def _numbers(found: list[Message]) -> list[dict[str, Any]]:
    return [
        number
        for message in found
        for member in message.members
        for _, type in lower.cases(member.field)
        for number in lower.numbers(type)
    ]


def _wide(number: dict[str, Any]) -> bool:
    """Return whether the wire can carry numbers, legal or not, that int32_t cannot hold."""
    top, signed_at = 256 ** number["width"] - 1, number["signed_at"]
    return bool(signed_at >= 2**31 or (signed_at < top and signed_at - top < -(2**31)))
