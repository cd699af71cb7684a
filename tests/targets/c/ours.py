"""Bring the results of our codec and of the C code to the same representation."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import Any

from cobotwire.codec.events import DecodedMessage as Read
from cobotwire.codec.interface import Codec, Event, Frame
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction, Variant
from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.c.messages import messages
from strategies import CommandVariant
from targets.c import peer


class CodecSide:
    """Results of one of our codecs, with messages numbered as in the C code."""

    def __init__(self, edition: Edition, codec: Codec) -> None:
        self.codec = codec
        self.messages = messages(edition)
        self.index = {
            (m.command.name, m.direction, m.number): i for i, m in enumerate(self.messages)
        }

    def number(self, variant: CommandVariant) -> int:
        """Return the C code's number of a variant."""
        return self._index(variant.command.name, variant.direction, variant.number)

    def _index(self, command: str, direction: Direction, number: int) -> int:
        """Return the C code's number; the sizes of a list are one message there."""
        return self.index.get((command, direction, number), self.index[command, direction, 0])

    def flat(self, message: int, variant: Variant, values: Sequence[Any]) -> list[float]:
        """Return the fields' values as the numbers of a struct: no constants, but counts."""
        rows = [
            field.flatten(value, len(field.cases[0].numbers))
            for field, value in zip(variant.fields, values)
        ]
        return self.flat_rows(message, rows)

    def flat_rows(self, message: int, rows: Sequence[Sequence[float]]) -> list[float]:
        """Return rows of numbers, one for each field, as the numbers of a struct."""
        found: list[float] = []
        for member, row in zip(self.messages[message].members, rows):
            if member.counter:
                found.append(len(row) // (member.storage.each * len(member.storage.cases[0])))
            if member.count:
                found += [n if isinstance(n, float) else int(n) for n in row]
        return found

    def encoded(self, variant: CommandVariant, values: Sequence[Any]) -> object:
        """Return the frame, or the field and the element that is rejected."""
        return _or_rejection(
            lambda: self.codec.encode(
                variant.command.name, variant.direction, values, variant=variant.number
            ),
            variant,
        )

    def rejected_in_c(self, found: object) -> object:
        """Return a rejection by the C code as ``encoded`` returns ours."""
        if not isinstance(found, peer.Outcome) or found.status != "bad-value":
            return found
        member = self.messages[found.message].members[found.field]
        return member.field.name, found.element

    def read(self, direction: Direction, data: bytes, of: str | None = None) -> object:
        """Return what our codec reads, or its rejection, as ``read_in_c`` returns it."""
        try:
            return self._as_read(self.codec.decode(direction, data, of=of), data)
        except ProtocolError as error:
            return error.reason, error.offset, _field(error)

    def event(self, frame: Frame) -> object:
        """Return the message of a framer's frame, or its rejection, as ``read`` does."""
        try:
            return self._as_read(frame.message, frame.data)
        except ProtocolError as error:
            return error.reason, error.offset, _field(error)

    def _as_read(self, found: Read, data: bytes) -> object:
        variants = found.command.variants(found.direction)
        number = next(i for i, variant in enumerate(variants) if variant is found.variant)
        index = self._index(found.command.name, found.direction, number)
        raw_values = found.variant.unpack(self.codec.table.frame.data(data, found.direction))
        return peer.Read(
            index,
            [int(raw) for raw in self.flat_rows(index, raw_values)],
            [peer.comparable(value) for value in self.flat(index, found.variant, found.values)],
        )

    def read_in_c(self, found: peer.Read | peer.Outcome) -> object:
        """Return what the C code read, or its rejection: reason, offset, command and field."""
        if isinstance(found, peer.Read):
            return found
        name = ""
        if found.status == "bad-value":
            message = self.messages[found.message]
            name = f"{message.command.name}: {message.members[found.field].field.name}"
        return found.status, found.offset, name


def _or_rejection(build: Callable[[], bytes], variant: CommandVariant) -> object:
    try:
        return build()
    except UsageError as error:
        return _argument(error.argument, variant)


def _argument(argument: str, variant: CommandVariant) -> object:
    for field in variant.variant.fields:
        # Each case has its own names for its elements.
        for element, number in chain.from_iterable(enumerate(c.numbers) for c in field.cases):
            part = f".{number.name}" if number.name else f"[{element}]"
            if argument == field.name + (part if field.many else ""):
                return field.name, element
    return argument


def _field(error: ProtocolError) -> str:
    """Return the command and the field that an error names."""
    if error.reason != "bad-value":
        return ""
    command, _, rest = str(error).partition(": ")
    # "byte 3 of label is ...", "joints[1].angle is ..."
    field = re.split(r"[.\[]", rest.partition(" is ")[0].rpartition(" of ")[2])[0]
    return f"{command}: {field}"


def events(found: Sequence[Event]) -> Iterator[peer.Event]:
    """Yield our framer's events as events of the C code."""
    for event in found:
        reason = "ok" if isinstance(event, Frame) else event.reason
        yield peer.Event(reason, event.offset, event.data)
