"""Our codec's words and the C code's, brought to the same form."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import Any

from cobotwire.codec.events import Message as Read
from cobotwire.codec.interface import Codec, Event, Frame
from cobotwire.codec.reference.decode import whole_numbers
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.table import Direction
from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.c.messages import messages
from strategies import Form
from targets.c import peer


class Beside:
    """An edition's messages as the C code numbers them, beside a codec of ours."""

    def __init__(self, edition: Edition, codec: Codec) -> None:
        self.codec = codec
        self.messages = messages(edition)
        self.index = {
            (m.command.name, m.direction, m.number): i for i, m in enumerate(self.messages)
        }

    def number(self, form: Form) -> int:
        """The C code's number of a form."""
        return self.index[form.command.name, form.direction, form.number]

    def flat(self, message: int, values: Sequence[Any]) -> list[float]:
        """Values, one a field, as the numbers of a struct: constants have no place there."""
        return [
            float(number) if isinstance(number, float) else int(number)
            for member, value in zip(self.messages[message].members, values)
            for number in (value if isinstance(value, tuple) else (value,))
            if member.count
        ]

    def encoded(self, form: Form, values: Sequence[Any]) -> object:
        """The frame, or the field and the element that is refused."""
        return _or_refusal(
            lambda: self.codec.encode(form.command.name, form.direction, values, form=form.number),
            form,
        )

    def refused_in_c(self, found: object) -> object:
        """A refusal of the C code as ``encoded`` tells it."""
        if not isinstance(found, peer.Outcome) or found.status != "bad-value":
            return found
        member = self.messages[found.message].members[found.field]
        return member.field.name, found.element

    def read(self, direction: Direction, data: bytes, of: str | None = None) -> object:
        """What our codec reads, or its refusal, as ``read_in_c`` tells it."""
        try:
            return self._told(self.codec.decode(direction, data, of=of), data)
        except ProtocolError as error:
            return error.reason, error.offset, _field(error)

    def event(self, frame: Frame) -> object:
        """What a frame of a framer says, told likewise."""
        try:
            return self._told(frame.message, frame.data)
        except ProtocolError as error:
            return error.reason, error.offset, _field(error)

    def _told(self, found: Read, data: bytes) -> object:
        forms = found.command.layouts(found.direction)
        number = next(i for i, layout in enumerate(forms) if layout is found.layout)
        index = self.index[found.command.name, found.direction, number]
        wholes = whole_numbers(self.codec.table.frame, found.layout, data)
        return peer.Read(
            index,
            [int(whole) for whole in self.flat(index, wholes)],
            [float(value) for value in self.flat(index, found.values)],
        )

    def read_in_c(self, found: peer.Read | peer.Outcome) -> object:
        """What the C code read, or its refusal: why, where, and which field of which command."""
        if isinstance(found, peer.Read):
            return found
        name = ""
        if found.status == "bad-value":
            message = self.messages[found.message]
            name = f"{message.command.name}: {message.members[found.field].field.name}"
        return found.status, found.offset, name


def _or_refusal(build: Callable[[], bytes], form: Form) -> object:
    try:
        return build()
    except UsageError as error:
        return _argument(error.argument, form)


def _argument(argument: str, form: Form) -> object:
    for field in form.layout.fields:
        # Each case has names of its own for the elements.
        for element, number in chain.from_iterable(enumerate(c.numbers) for c in field.cases):
            part = f".{number.name}" if number.name else f"[{element}]"
            if argument == field.name + (part if field.many else ""):
                return field.name, element
    return argument


def _field(error: ProtocolError) -> str:
    """The command and the field that a refusal names."""
    return str(error).partition(" holds ")[0] if error.reason == "bad-value" else ""


def events(found: Sequence[Event]) -> Iterator[peer.Event]:
    """Our framer's events in the C code's words."""
    for event in found:
        reason = "ok" if isinstance(event, Frame) else event.reason
        yield peer.Event(reason, event.offset, event.data)
