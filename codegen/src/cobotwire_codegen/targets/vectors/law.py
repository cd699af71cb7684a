"""Implements framing and decoding again, directly from the model and without optimization.

Vectors take their expected results from here, not from a codec, so they can prove a codec wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from cobotwire_codegen.model import Command, Edition, Variant
from cobotwire_codegen.targets.vectors.slots import RawValues, slots
from cobotwire_codegen.wire import check_of, size

Direction = Literal["request", "reply"]


class Fault(NamedTuple):
    """Why bytes are not a message, and the index of the first byte that is not legal."""

    reason: str
    offset: int


class Reading(NamedTuple):
    """A decoded frame."""

    command: Command
    variant: Variant
    raw_values: RawValues


class Span(NamedTuple):
    """A part of a stream: a frame with its id, or noise with its reason."""

    offset: int
    size: int
    id: int | None
    reason: str


class Law:
    """The frames that are legal in one direction of an edition."""

    def __init__(self, edition: Edition, direction: Direction) -> None:
        self._frame = edition.frame
        self._addresses = {member.value for member in edition.frame.addresses}
        self._variants: dict[int, list[tuple[Command, Variant]]] = {}
        for command in edition.commands:
            for variant in command.variants(direction):
                self._variants.setdefault(command.id, []).append((command, variant))
        # The index of LEN; CMD follows it, then the data.
        self._at = len(edition.frame.header) + bool(self._addresses)
        self._lengths = {length for id in self._variants for length in self._lengths_of(id)}

    def frame_fault(self, data: bytes) -> Fault | None:
        """Return why ``data`` does not begin with a frame; None if it does.

        The reason is ``truncated`` if more bytes could still complete a frame.
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
        if id not in self._variants:
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
        """Return one complete frame decoded as the first message that allows its values."""
        fault = self.frame_fault(data)
        if fault is not None:
            return fault
        end = self._at + 1 + data[self._at]
        if len(data) > end:
            return Fault("trailing", end)
        return self._read(data[self._at + 1], data[self._at + 2 : end - self._frame.check_size])

    def _read(self, id: int, data: bytes) -> Reading | Fault:
        first = None
        for command, variant in self._variants[id]:
            if _size(variant) != len(data):
                continue
            found = self._raw_values(variant, data)
            if not isinstance(found, Fault):
                return Reading(command, variant, found)
            first = first or found
        assert first is not None, "LEN was legal for the id"
        return first

    def _raw_values(self, variant: Variant, data: bytes) -> RawValues | Fault:
        starts = dict(zip((field.name for field in variant), _starts(variant)))
        found: RawValues = {}
        picked = _unchecked(variant, data)
        for field in variant:
            parts = slots(field, variant, picked)
            if parts is None:
                return Fault("bad-value", self._at + 2 + starts[field.selector])
            at = starts[field.name]
            numbers = []
            for slot in parts:
                raw = slot.read(data[at : at + slot.wire.width])
                if not slot.allows(raw):
                    return Fault("bad-value", self._at + 2 + at)
                numbers.append(raw)
                at += slot.wire.width
            found[field.name] = tuple(numbers)
        return found

    def cut(self, stream: bytes) -> Iterator[Span]:
        """Return the frames and noise of a complete stream; each byte of noise has a reason.

        Adjacent bytes of noise with the same reason are one span.
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
        return {overhead + _size(variant) for _, variant in self._variants[id]}


def _starts(variant: Variant) -> list[int]:
    """Return where in the data each field begins."""
    sizes = [size(field.type) for field in variant]
    return [sum(sizes[:index]) for index in range(len(variant))]


def _unchecked(variant: Variant, data: bytes) -> RawValues:
    """Return the raw values, legal or not, of the fields that can be selectors."""
    return {
        field.name: tuple(slot.read(data[at : at + slot.wire.width]) for slot in parts[:1])
        for field, at in zip(variant, _starts(variant))
        if not field.selector and (parts := slots(field, variant, {}))
    }


def _size(variant: Variant) -> int:
    return sum(size(field.type) for field in variant)
