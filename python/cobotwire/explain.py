"""Bytes in words: what each byte of a capture is, or why it is nothing."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, Event, Frame, Message, Noise
from cobotwire.errors import ProtocolError
from cobotwire.table import Direction, Field, FrameFormat, Number

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


class Part(NamedTuple):
    """A run of bytes inside a frame, and what it says."""

    offset: int
    data: bytes
    name: str
    meaning: str


class Reading(NamedTuple):
    """One way to read a frame: a message, or the reason why it is none."""

    direction: Direction
    message: Message | None
    error: ProtocolError | None


class Explained(NamedTuple):
    """A frame or a span of noise with everything that can be said of it."""

    event: Event
    readings: tuple[Reading, ...]

    @property
    def legal(self) -> bool:
        """Whether it is a frame that the edition allows."""
        return isinstance(self.event, Frame) and any(r.message for r in self.readings)


def explain(
    codec: Codec, data: bytes, directions: tuple[Direction, ...] = DIRECTIONS
) -> list[Explained]:
    """Cut ``data`` into frames and noise, and read each frame in every direction that fits."""
    framer = codec.framer(directions[0] if len(directions) == 1 else "both")
    events = _join_noise([*framer.feed(data), *framer.flush()])
    return [Explained(event, readings(codec, event.data, directions)) for event in events]


def _join_noise(events: list[Event]) -> list[Event]:
    """Noise between two frames as one span, with the reason of its first byte."""
    joined: list[Event] = []
    for event in events:
        last = joined[-1] if joined else None
        if isinstance(event, Noise) and isinstance(last, Noise):
            joined[-1] = last._replace(data=last.data + event.data)
        else:
            joined.append(event)
    return joined


def readings(
    codec: Codec, data: bytes, directions: tuple[Direction, ...] = DIRECTIONS
) -> tuple[Reading, ...]:
    """The messages that ``data`` is; if it is none, the reasons why not.

    Nothing is said of bytes that do not start as a frame does.
    """
    if not data.startswith(codec.table.frame.header):
        return ()
    found = tuple(_read(codec, data, direction) for direction in directions)
    messages = tuple(reading for reading in found if reading.message is not None)
    # A frame that fits one direction is not explained in the other, where it does not.
    bad_values = tuple(r for r in found if r.error is not None and r.error.reason == "bad-value")
    return messages or bad_values or found


def _read(codec: Codec, data: bytes, direction: Direction) -> Reading:
    try:
        return Reading(direction, codec.decode(direction, data), None)
    except ProtocolError as error:
        return Reading(direction, None, error)


def parts(frame: FrameFormat, data: bytes, message: Message) -> Iterator[Part]:
    """Every byte of a legal frame, in order."""
    start = frame.length_at
    yield Part(0, data[: len(frame.header)], "header", "a frame starts here")
    if message.address is not None:
        yield Part(start - 1, data[start - 1 : start], "address", str(message.address))
    length = data[start]
    yield Part(start, data[start : start + 1], "LEN", f"{length}: {length} bytes follow")
    command = message.command
    yield Part(start + 1, data[start + 1 : start + 2], "CMD", f"{command.name}: {command.title}")
    offset = frame.overhead + 1
    for field, value in zip(message.layout.fields, message.values):
        for number, single in _numbers(message, field, value):
            name = f"{field.name} {number.name}".strip()
            chunk = data[offset : offset + number.width]
            yield Part(offset, chunk, name, in_words(field, number, single))
            offset += number.width
    end = "footer" if frame.check == "footer" else "check"
    yield Part(offset, data[offset:], end, "the frame ends here")


def _numbers(message: Message, field: Field, value: Any) -> Iterator[tuple[Number, Any]]:
    case = field.cases[0]
    if field.selector >= 0:
        picked = message.values[field.selector]
        case = next(case for case in field.cases if picked in case.when)
    yield from zip(case.numbers, value if field.many else (value,))


def in_words(field: Field, number: Number, value: Any) -> str:
    """One value with its unit or label."""
    if field.kind == "flag":
        return "yes" if value else "no"
    if field.labels:
        return f"{field.labels[field.choices.index(value)]} ({value})"
    unit = f" {number.unit}" if number.unit else ""
    return f"{value:g}{unit}" if isinstance(value, float) else f"{value}{unit}"


def summary(message: Message) -> str:
    """A message on one line: the call, or the answer."""
    values = []
    for field, value in zip(message.layout.fields, message.values):
        words = _tuple_in_words(_numbers(message, field, value))
        if not field.many:
            words = in_words(field, *next(_numbers(message, field, value)))
        values.append(f"{field.name}={words}")
    arrow = "" if message.direction == "request" else "-> "
    return f"{arrow}{message.command.name}({', '.join(values)})"


def _tuple_in_words(numbers: Iterator[tuple[Number, Any]]) -> str:
    """A tuple with each unit once: ``(0, 0, 50 millimetre; 0, 0, 0 degree)``."""
    groups = []
    for unit, group in groupby(numbers, key=lambda pair: pair[0].unit):
        values = ", ".join(f"{value:g}" for _, value in group)
        groups.append(f"{values} {unit}".strip())
    return f"({'; '.join(groups)})"
