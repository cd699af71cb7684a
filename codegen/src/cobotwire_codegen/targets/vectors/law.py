"""Implements framing and decoding again, directly from the model and without optimization.

Vectors take their expected results from here, not from a codec, so they can prove a codec wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from cobotwire_codegen.model import Command, Edition, FrameNumber, Variant
from cobotwire_codegen.targets.vectors.sizes import data_size, fixed_sizes
from cobotwire_codegen.targets.vectors.slots import RawValues, bad_text_at, slots
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
        self._frame, self._direction = edition.frame, direction
        # By id, and by LEN; without ids, all under None.
        self._variants: dict[int | None, dict[int, list[tuple[Command, Variant]]]] = {}
        for command in edition.commands:
            for several in command.variants(direction):
                known = self._variants.setdefault(self._key(command.id), {})
                for variant in fixed_sizes(several, edition.frame.maximum_data):
                    length = self._frame.length(data_size(variant), direction)
                    known.setdefault(length, []).append((command, variant))
        self._data_at = self._frame.data_at(direction)
        self._lengths = {length for known in self._variants.values() for length in known}

    def _key(self, id: int) -> int | None:
        return id if self._frame.has_command(self._direction) else None

    def frame_fault(self, data: bytes) -> Fault | None:
        """Return why ``data`` does not begin with a frame; None if it does.

        The reason is ``truncated`` if more bytes could still complete a frame.
        """
        for index, byte in enumerate(self._frame.header):
            if index >= len(data):
                return Fault("truncated", index)
            if data[index] != byte:
                return Fault("no-header", index)
        for part in self._frame.layout:
            fault = self._part_fault(data, part)
            if fault is not None:
                return fault
        return self._end_fault(data)

    def _part_fault(self, data: bytes, part: str) -> Fault | None:
        """Return why a frame is rejected at a part, given those before it; None if it is not."""
        frame, at = self._frame, self._frame.offset(part)
        if len(data) < at + frame.sizes[part]:
            return Fault("truncated", len(data))
        if part == "address":
            legal = not frame.address_values or data[at] in frame.address_values
            return None if legal else Fault("bad-address", at)
        if part == "length" and self._length(data) not in self._lengths:
            known = frame.layout.index("command") > frame.layout.index("length")
            if known or self._key(self._id(data)) in self._variants:
                return Fault("bad-length", at)
        if part == "command" and frame.layout.index("length") > frame.layout.index("command"):
            known = self._key(self._id(data)) in self._variants
            return None if known else Fault("unknown-id", at)
        return self._pair_fault(data) if part == frame.layout[-1] else None

    def _pair_fault(self, data: bytes) -> Fault | None:
        key = self._key(self._id(data))
        if key not in self._variants:
            return Fault("unknown-id", self._frame.offset("command"))
        if self._length(data) not in self._variants[key]:
            return Fault("bad-length", self._frame.offset("length"))
        return None

    def _end_fault(self, data: bytes) -> Fault | None:
        end = self._size(data)
        if len(data) < end:
            return Fault("truncated", len(data))
        check = end - self._frame.check_size
        right = check_of(self._frame, data[:check])
        return None if data[check:end] == right else Fault("bad-check", check)

    def _length(self, data: bytes) -> int:
        return self._number(data, "length", self._frame.length_number)

    def _id(self, data: bytes) -> int:
        return self._number(data, "command", self._frame.command_number)

    def _number(self, data: bytes, part: str, form: FrameNumber) -> int:
        at = self._frame.offset(part)
        return int.from_bytes(data[at : at + form.width], form.order)

    def _size(self, data: bytes) -> int:
        """Return the size of a frame, which its LEN states."""
        least = self._data_at + self._frame.check_size
        return least + self._length(data) - self._frame.length(0, self._direction)

    def read(self, data: bytes) -> Reading | Fault:
        """Return one complete frame decoded as the first message that allows its values."""
        fault = self.frame_fault(data)
        if fault is not None:
            return fault
        end = self._size(data)
        if len(data) > end:
            return Fault("trailing", end)
        payload = data[self._data_at : end - self._frame.check_size]
        variants = self._variants[self._key(self._id(data))][self._length(data)]
        return self._read(variants, payload)

    def _read(self, variants: list[tuple[Command, Variant]], data: bytes) -> Reading | Fault:
        first = None
        for command, variant in variants:
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
                return Fault("bad-value", self._data_at + starts[field.selector])
            at = starts[field.name]
            numbers = []
            for slot in parts:
                raw = slot.read(data[at : at + slot.wire.width])
                if not slot.allows(raw):
                    return Fault("bad-value", self._data_at + at)
                numbers.append(raw)
                at += slot.step
            found[field.name] = tuple(numbers)
            bad = bad_text_at(field, found[field.name])
            if bad is not None:
                return Fault("bad-value", self._data_at + starts[field.name] + bad)
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
                noise, size = None, self._size(stream[at:])
                yield Span(at, size, self._id(stream[at:]), "")
                at += size
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
