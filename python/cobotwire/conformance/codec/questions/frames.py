"""Questions about single messages: values to bytes and back, and what must be rejected."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from typing import NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json, Question, hexed
from cobotwire.conformance.samples.physical import between_steps, named_values, wrong_counts
from cobotwire.conformance.samples.raw import Sample, illegal_samples, ordinary, samples
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Direction, Table, Variant

# Functions of a variant: one yields samples, the other pairs of a question's name and its values.
SamplesOf = Callable[[Variant], Iterator[Sample]]
ValuesOf = Callable[[Variant], Iterator[tuple[str, Json]]]

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
SOURCE = "docs/codec-protocol.md"
ENCODE_BYTES = TestCase(
    "encode-bytes",
    "Values are encoded to exactly these bytes, rounded to the nearest step.",
    SOURCE,
)
ENCODE_REJECTS = TestCase(
    "encode-rejects", "A value that the field does not allow is rejected.", SOURCE
)
DECODE_VALUES = TestCase(
    "decode-values", "A legal frame is decoded to the values that it holds.", SOURCE
)
DECODE_REJECTS = TestCase(
    "decode-rejects", "A frame that is not legal, or holds an illegal value, is rejected.", SOURCE
)
REJECTION_REASON = TestCase("rejection-reason", "A rejection names its reason and byte.", SOURCE)


class CommandVariant(NamedTuple):
    """One variant of one message; ``label`` names it in questions."""

    command: Command
    direction: Direction
    variant: Variant
    label: str


def variants_of(table: Table) -> Iterator[CommandVariant]:
    """Yield every variant of every framed message of an edition."""
    for command in table.commands:
        for direction in DIRECTIONS:
            variants = command.variants(direction)
            for index, variant in enumerate(variants):
                suffix = f".{index + 1}" if len(variants) > 1 else ""
                yield CommandVariant(
                    command, direction, variant, f"{command.name}/{direction}{suffix}"
                )


def frame_of(table: Table, id: int, data: bytes, direction: Direction = "request") -> bytes:
    """Return a whole frame around data bytes, legal or not."""
    return table.frame.enclose(id, data, direction=direction)


def ordinary_frame(table: Table, variant: CommandVariant, turn: int = 0) -> bytes:
    """Return the frame of a variant with ordinary values; another ``turn`` gives other values."""
    data = variant.variant.pack(ordinary(variant.variant, turn=turn))
    return frame_of(table, variant.command.id, data, variant.direction)


def _encoding(samples_of: SamplesOf, values_of: ValuesOf, codec: Codec) -> Iterator[Question]:
    """Yield questions that encode samples and other values; skip bytes that are no legal text."""
    for variant in variants_of(codec.table):
        for sample in samples_of(variant.variant):
            with suppress(UnicodeDecodeError):
                values = named_values(variant.variant, sample.raw_values)
                yield _encode(codec, variant, sample.name, values)
        for name, values in values_of(variant.variant):
            yield _encode(codec, variant, name, values)


def _encode(codec: Codec, variant: CommandVariant, name: str, values: Json) -> Question:
    command, direction = variant.command.name, variant.direction
    ask = {"do": "encode", "direction": direction, "command": command, "fields": values}
    expect = OurCodec(codec).ask(ask)
    case = ENCODE_REJECTS if "error" in expect else ENCODE_BYTES
    return Question(f"{case.id}/{variant.label}/{name}", case, command, ask, expect)


def _decoding(samples_of: SamplesOf, codec: Codec) -> Iterator[Question]:
    """Yield questions that decode the frames of samples."""
    for variant in variants_of(codec.table):
        command, direction = variant.command, variant.direction
        for sample in samples_of(variant.variant):
            data = variant.variant.pack(sample.raw_values)
            frame = frame_of(codec.table, command.id, data, direction)
            yield decode(codec, direction, command.name, f"{variant.label}/{sample.name}", frame)


def decode(codec: Codec, direction: Direction, of: str, name: str, data: bytes) -> Question:
    """Return the question that decodes bytes; with an empty ``of`` it names no command."""
    ask: Json = {"do": "decode", "direction": direction, "bytes": hexed(data)}
    if of:
        ask["command"] = of
    expect = OurCodec(codec).ask(ask)
    case = DECODE_REJECTS if "error" in expect else DECODE_VALUES
    return Question(f"{case.id}/{name}", case, of, ask, expect)


ENCODING = Group(
    "encoding",
    (ENCODE_BYTES, ENCODE_REJECTS),
    partial(_encoding, samples, between_steps),
    sends="Ordinary values, corner values, and values between two steps, to be encoded.",
    subject="each variant of each message",
)
REJECTED_VALUES = Group(
    "rejected values",
    (ENCODE_REJECTS, ENCODE_BYTES),
    partial(_encoding, illegal_samples, wrong_counts),
    sends="Values that are not allowed, and lists with too few or too many numbers, to be encoded.",
    subject="each variant of each message",
)
DECODING = Group(
    "decoding",
    (DECODE_VALUES,),
    partial(_decoding, samples),
    sends="Legal frames, to be decoded.",
    subject="each variant of each message",
)
REJECTED_NUMBERS = Group(
    "rejected numbers",
    (DECODE_REJECTS, REJECTION_REASON),
    partial(_decoding, illegal_samples),
    sends="Frames with numbers that are not allowed, to be decoded.",
    subject="each variant of each message",
)
