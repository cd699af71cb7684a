"""Bring the results of our codec and of the C code to the same representation."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import Any

from cobotwire.codec.events import DecodedMessage as Read
from cobotwire.codec.interface import Codec, Event, Frame
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction
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
        return self.index[variant.command.name, variant.direction, variant.number]

    def flat(self, message: int, values: Sequence[Any]) -> list[float]:
        """Return the fields' values as the numbers of a struct, which leaves out constants."""
        return [
            float(number) if isinstance(number, float) else int(number)
            for member, value in zip(self.messages[message].members, values)
            for number in (value if isinstance(value, tuple) else (value,))
            if member.count
        ]

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
        index = self.index[found.command.name, found.direction, number]
        raw_values = found.variant.unpack(self.codec.table.frame.data(data))
        return peer.Read(
            index,
            [int(raw) for raw in self.flat(index, raw_values)],
            [float(value) for value in self.flat(index, found.values)],
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
    return str(error).partition(" is ")[0] if error.reason == "bad-value" else ""


def events(found: Sequence[Event]) -> Iterator[peer.Event]:
    """Yield our framer's events as events of the C code."""
    for event in found:
        reason = "ok" if isinstance(event, Frame) else event.reason
        yield peer.Event(reason, event.offset, event.data)
