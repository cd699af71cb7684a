"""Questions about single messages: values to bytes and back, and what must be rejected."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json, Question, hexed
from cobotwire.conformance.samples.physical import between_steps, named_values, wrong_counts
from cobotwire.conformance.samples.raw import Sample, illegal_samples, ordinary, samples
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Direction, Table, Variant

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
    """Return the frame of a variant with ordinary values, which differ by ``turn``."""
    data = variant.variant.pack(ordinary(variant.variant, turn=turn))
    return frame_of(table, variant.command.id, data, variant.direction)


def _encoding(codec: Codec) -> Iterator[Question]:
    """Yield questions with ordinary values, corner values and values between two steps."""
    for variant in variants_of(codec.table):
        for sample in samples(variant.variant):
            yield from _encode_sample(codec, variant, sample)
        for name, values in between_steps(variant.variant):
            yield _encode(codec, variant, name, values)


def _rejected_values(codec: Codec) -> Iterator[Question]:
    """Yield values that must be rejected, though the wire could carry most of them."""
    for variant in variants_of(codec.table):
        for sample in illegal_samples(variant.variant):
            yield from _encode_sample(codec, variant, sample)
        for name, values in wrong_counts(variant.variant):
            yield _encode(codec, variant, name, values)


def _encode_sample(codec: Codec, variant: CommandVariant, sample: Sample) -> Iterator[Question]:
    """Yield the question that encodes a sample; none if its bytes are no text."""
    with suppress(UnicodeDecodeError):
        values = named_values(variant.variant, sample.raw_values)
        yield _encode(codec, variant, sample.name, values)


def _encode(codec: Codec, variant: CommandVariant, name: str, values: Json) -> Question:
    command, direction = variant.command.name, variant.direction
    ask = {"do": "encode", "direction": direction, "command": command, "fields": values}
    expect = OurCodec(codec).ask(ask)
    case = ENCODE_REJECTS if "error" in expect else ENCODE_BYTES
    return Question(f"{case.id}/{variant.label}/{name}", case, command, ask, expect)


def _decoding(codec: Codec) -> Iterator[Question]:
    """Yield legal frames with ordinary values and with their corners."""
    for variant in variants_of(codec.table):
        for sample in samples(variant.variant):
            yield _of_sample(codec, variant, sample)


def _rejected_numbers(codec: Codec) -> Iterator[Question]:
    """Yield frames that hold a number which the edition does not allow."""
    for variant in variants_of(codec.table):
        for sample in illegal_samples(variant.variant):
            yield _of_sample(codec, variant, sample)


def _of_sample(codec: Codec, variant: CommandVariant, sample: Sample) -> Question:
    data = frame_of(
        codec.table, variant.command.id, variant.variant.pack(sample.raw_values), variant.direction
    )
    return decode(
        codec, variant.direction, variant.command.name, f"{variant.label}/{sample.name}", data
    )


def decode(codec: Codec, direction: Direction, of: str, name: str, data: bytes) -> Question:
    """Return the question that decodes bytes; an empty ``of`` leaves the command open."""
    ask: Json = {"do": "decode", "direction": direction, "bytes": hexed(data)}
    if of:
        ask["command"] = of
    expect = OurCodec(codec).ask(ask)
    case = DECODE_REJECTS if "error" in expect else DECODE_VALUES
    return Question(f"{case.id}/{name}", case, of, ask, expect)


ENCODING = Group(
    "encoding",
    (ENCODE_BYTES, ENCODE_REJECTS),
    _encoding,
    sends="Ordinary values, corner values, and values between two steps, to be encoded.",
    subject="each variant of each message",
)
REJECTED_VALUES = Group(
    "rejected values",
    (ENCODE_REJECTS, ENCODE_BYTES),
    _rejected_values,
    sends="Values that are not allowed, and rows with too few and too many numbers, to be encoded.",
    subject="each variant of each message",
)
DECODING = Group(
    "decoding",
    (DECODE_VALUES,),
    _decoding,
    sends="Legal frames, to be decoded.",
    subject="each variant of each message",
)
REJECTED_NUMBERS = Group(
    "rejected numbers",
    (DECODE_REJECTS, REJECTION_REASON),
    _rejected_numbers,
    sends="Frames with numbers that are not allowed, to be decoded.",
    subject="each variant of each message",
)
