"""The law of framing and reading once more, straight from the model and without haste.

What vectors expect comes from here, not from a codec: so they can show that a codec is wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from cobotwire_codegen.model import Command, Edition, Form
from cobotwire_codegen.targets.vectors.slots import Wholes, slots
from cobotwire_codegen.wire import check_of, size

Direction = Literal["request", "reply"]


class Fault(NamedTuple):
    """Why bytes are no message, and at which byte that shows."""

    reason: str
    offset: int


class Reading(NamedTuple):
    """What a frame says."""

    command: Command
    form: Form
    wholes: Wholes


class Span(NamedTuple):
    """A part of a stream: a frame with its id, or noise with its reason."""

    offset: int
    size: int
    id: int | None
    reason: str


class Law:
    """What is legal in one direction of an edition."""

    def __init__(self, edition: Edition, direction: Direction) -> None:
        self._frame = edition.frame
        self._addresses = {member.value for member in edition.frame.addresses}
        self._forms: dict[int, list[tuple[Command, Form]]] = {}
        for command in edition.commands:
            for form in command.forms(direction):
                self._forms.setdefault(command.id, []).append((command, form))
        # Where LEN stands; CMD is behind it, and the data behind that.
        self._at = len(edition.frame.header) + bool(self._addresses)
        self._lengths = {length for id in self._forms for length in self._lengths_of(id)}

    def frame_fault(self, data: bytes) -> Fault | None:
        """Why ``data`` does not begin with a frame; None: it does.

        ``truncated`` where more bytes could still make it one.
        """
        for index, byte in enumerate(self._frame.header):
            if index >= len(data):
                return Fault("truncated", index)
            if data[index] != byte:
                return Fault("no-header", index)
        if self._addresses and len(data) >= self._at and data[self._at - 1] not in self._addresses:
            return Fault("bad-address", self._at - 1)
        if len(data) <= self._at:
            return Fault("truncated", len(data))
        if data[self._at] not in self._lengths:
            return Fault("bad-length", self._at)
        if len(data) == self._at + 1:
            return Fault("truncated", len(data))
        return self._end_fault(data, data[self._at], data[self._at + 1])

    def _end_fault(self, data: bytes, length: int, id: int) -> Fault | None:
        if id not in self._forms:
            return Fault("unknown-id", self._at + 1)
        if length not in self._lengths_of(id):
            return Fault("bad-length", self._at)
        end = self._at + 1 + length
        if len(data) < end:
            return Fault("truncated", len(data))
        check = end - self._frame.check_size
        right = check_of(self._frame, data[:check], check - self._at - 2)
        return None if data[check:end] == right else Fault("bad-check", check)

    def read(self, data: bytes) -> Reading | Fault:
        """What one whole frame says, as the first message that allows its values."""
        fault = self.frame_fault(data)
        if fault is not None:
            return fault
        end = self._at + 1 + data[self._at]
        if len(data) > end:
            return Fault("trailing", end)
        return self._read(data[self._at + 1], data[self._at + 2 : end - self._frame.check_size])

    def _read(self, id: int, data: bytes) -> Reading | Fault:
        first = None
        for command, form in self._forms[id]:
            if _size(form) != len(data):
                continue
            found = self._wholes(form, data)
            if not isinstance(found, Fault):
                return Reading(command, form, found)
            first = first or found
        assert first is not None, "LEN was legal for the id"
        return first

    def _wholes(self, form: Form, data: bytes) -> Wholes | Fault:
        starts = dict(zip((field.name for field in form), _starts(form)))
        found: Wholes = {}
        picked = _unchecked(form, data)
        for field in form:
            parts = slots(field, form, picked)
            if parts is None:
                return Fault("bad-value", self._at + 2 + starts[field.by])
            at = starts[field.name]
            numbers = []
            for slot in parts:
                whole = slot.read(data[at : at + slot.wire.width])
                if not slot.allows(whole):
                    return Fault("bad-value", self._at + 2 + at)
                numbers.append(whole)
                at += slot.wire.width
            found[field.name] = tuple(numbers)
        return found

    def cut(self, stream: bytes) -> Iterator[Span]:
        """A stream that ends, in frames and noise; each byte is judged on its own.

        Adjacent noise of one reason is one span.
        """
        noise: Span | None = None
        at = 0
        while at < len(stream):
            fault = self.frame_fault(stream[at:])
            if fault is None:
                if noise:
                    yield noise
                noise, length = None, self._at + 1 + stream[at + self._at]
                yield Span(at, length, stream[at + self._at + 1], "")
                at += length
                continue
            if noise and noise.reason == fault.reason:
                noise = noise._replace(size=noise.size + 1)
            else:
                if noise:
                    yield noise
                noise = Span(at, 1, None, fault.reason)
            at += 1
        if noise:
            yield noise

    def _lengths_of(self, id: int) -> set[int]:
        overhead = 1 + self._frame.check_size
        return {overhead + _size(form) for _, form in self._forms[id]}


def _starts(form: Form) -> list[int]:
    """Where in the data each field begins."""
    sizes = [size(field.type) for field in form]
    return [sum(sizes[:index]) for index in range(len(form))]


def _unchecked(form: Form, data: bytes) -> Wholes:
    """The numbers of the fields that stand for themselves, legal or not; they may pick cases."""
    return {
        field.name: tuple(slot.read(data[at : at + slot.wire.width]) for slot in parts[:1])
        for field, at in zip(form, _starts(form))
        if not field.by and (parts := slots(field, form, {}))
    }


def _size(form: Form) -> int:
    return sum(size(field.type) for field in form)
