"""Questions about streams: frames among noise, in chunks, with silences between them."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from itertools import pairwise

from cobotwire.codec.interface import Codec, Listening
from cobotwire.conformance.codec.questions.frames import (
    CommandVariant,
    frame_of,
    ordinary_frame,
    variants_of,
)
from cobotwire.conformance.codec.questions.malformed import damages
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json, Question, hexed
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Table
from cobotwire.simulator.faults.noise import NOISE

# None: the line is silent, and the framer must decide about the bytes that it still holds.
Chunks = Sequence[bytes | None]

SOURCE = "docs/framing.md"
STREAM_FRAMES = TestCase(
    "stream-frames", "Every undamaged frame is found at its offset, and no other.", SOURCE
)
STREAM_CHUNKS = TestCase(
    "stream-chunks",
    "A frame is reported as soon as the received bytes, or a silence after them, prove that it is "
    "one.",
    SOURCE,
)
STREAM_NOISE = TestCase(
    "stream-noise", "Every byte outside frames is reported as noise, once.", SOURCE
)
NOISE_REASON = TestCase(
    "noise-reason", "Noise names the reason why its bytes are not a frame.", SOURCE
)

LISTENING: tuple[Listening, ...] = ("request", "reply", "both")
# The classes of noise, from the simulator's catalogue; the bytes are the same in each run.
NOISE_CLASSES = (
    "servo",
    "servo FE",
    "command error",
    "nuls",
    "other baud rate",
    "garbage",
    "false header",
    "frame bytes",
)
RANDOM_STREAMS = 240


def _streams(codec: Codec) -> Iterator[Question]:
    """Yield streams with each variant among noise, with false headers, and of random pieces."""
    variants = list(variants_of(codec.table))
    sizes: set[tuple[str, int]] = set()
    for variant in variants:
        yield from _of_variant(codec, variant)
        # The effect of a silence depends on where a frame ends, not on its command.
        if (variant.direction, variant.variant.size) not in sizes:
            sizes.add((variant.direction, variant.variant.size))
            yield from _silences(codec, variant)
    for listening in LISTENING:
        matching = [variant for variant in variants if listening in (variant.direction, "both")]
        yield from _false_headers(codec, listening, matching)
        yield from _whole_inside(codec, listening, matching)
        for seed in range(RANDOM_STREAMS):
            yield _random(codec, listening, matching, seed)


def _of_variant(codec: Codec, variant: CommandVariant) -> Iterator[Question]:
    whole = ordinary_frame(codec.table, variant)
    after = ordinary_frame(codec.table, variant, turn=7)

    def question(name: str, chunks: Chunks) -> Question:
        return stream(
            codec, variant.direction, variant.command.name, f"{variant.label}/{name}", chunks
        )

    yield question("alone", [whole])
    yield question("byte-by-byte", [bytes([byte]) for byte in whole + after])
    yield question("silence-inside", [whole[:-1], None, whole[-1:], after])
    for name, broken in damages(codec.table, whole):
        yield question(f"{name}-then-whole", [broken + after])
    for index, noise in enumerate(_noises(codec.table)):
        yield question(f"noise-{index}", [noise + whole + noise + after + noise])
    for count in range(1, 5):
        yield question(f"header-bytes-{count}", [codec.table.frame.header[:1] * count + whole])


def _noises(table: Table) -> list[bytes]:
    """Return a piece of each class of noise."""
    return [NOISE[name].draw(_chance(name), table) for name in NOISE_CLASSES]


def _chance(seed: str) -> random.Random:
    """Return random numbers that are the same in each run."""
    return random.Random(seed)  # noqa: S311  (no secret; it must repeat)


def _silences(codec: Codec, variant: CommandVariant) -> Iterator[Question]:
    """Yield a damaged frame, a silence and a frame that the damaged one must not swallow."""
    whole = ordinary_frame(codec.table, variant)
    after = ordinary_frame(codec.table, variant, turn=7)
    for name, broken in damages(codec.table, whole):
        place = f"{variant.label}/{name}-silence-then-whole"
        yield stream(codec, variant.direction, variant.command.name, place, [broken, None, after])


def _false_headers(
    codec: Codec, listening: Listening, variants: Sequence[CommandVariant]
) -> Iterator[Question]:
    """Yield false headers before true frames; some are completed by the bytes that follow."""
    table = codec.table
    short = min((ordinary_frame(table, variant) for variant in variants), key=len)
    heads = {ordinary_frame(table, variant)[: table.frame.head_size] for variant in variants}
    longest = table.frame.overhead + table.frame.maximum_length
    for head in sorted(heads):
        for name, following in (
            ("one", short),
            ("many", short * (longest // len(short) + 2)),
            ("footers", short + table.frame.footer * longest),
        ):
            place = f"any/{listening}/false-{head.hex().upper()}-{name}"
            yield stream(codec, listening, "", place, [head + following])
            yield stream(codec, listening, "", f"{place}-chunked", cut(head + following, 3))


def _whole_inside(
    codec: Codec, listening: Listening, variants: Sequence[CommandVariant]
) -> Iterator[Question]:
    """Yield frames that contain a frame, which is found only if the outer check is wrong."""
    table = codec.table
    short = min((ordinary_frame(table, variant) for variant in variants), key=len)
    # A framer does not look at values, so one frame of each size will do.
    sizes = {(variant.direction, variant.variant.size): variant for variant in variants}
    for variant in sizes.values():
        ordinary = ordinary_frame(table, variant)
        room = len(table.frame.data(ordinary)) - len(short)
        if room < 0:
            continue
        data = bytes(room) + short
        whole = frame_of(table, variant.command.id, data, variant.direction)
        place = f"any/{listening}/around-a-frame-{variant.label}"
        yield stream(codec, listening, "", place, [whole + ordinary])
        broken = whole[:-1] + bytes([whole[-1] ^ 1])
        yield stream(codec, listening, "", f"{place}-broken", [broken + ordinary])


def _random(
    codec: Codec, listening: Listening, variants: Sequence[CommandVariant], seed: int
) -> Question:
    """Return a stream of pieces of all kinds, cut anywhere; the seed makes it repeatable."""
    chance = _chance(f"{listening} {seed}")
    data = b"".join(_piece(codec.table, variants, chance) for _ in range(chance.randint(2, 9)))
    cuts = sorted(chance.randint(0, len(data)) for _ in range(chance.randint(0, 6)))
    chunks: list[bytes | None] = []
    for start, end in pairwise([0, *cuts, len(data)]):
        chunks.append(data[start:end])
        if chance.random() < 0.15:
            chunks.append(None)
    return stream(codec, listening, "", f"any/{listening}/random-{seed}", chunks)


def _piece(table: Table, variants: Sequence[CommandVariant], chance: random.Random) -> bytes:
    whole = ordinary_frame(table, chance.choice(variants), chance.randint(0, 9))
    kind = chance.randint(0, 5)
    if kind == 0:
        return NOISE[chance.choice(NOISE_CLASSES)].draw(chance, table)
    if kind == 1:
        return whole[: chance.randint(1, len(whole))]
    if kind == 2:
        index = chance.randrange(len(whole))
        return whole[:index] + bytes([chance.randint(0, 255)]) + whole[index + 1 :]
    return whole


def cut(data: bytes, size: int) -> list[bytes]:
    """Return ``data`` in pieces of ``size`` bytes."""
    return [data[at : at + size] for at in range(0, len(data), size)]


def stream(codec: Codec, listening: Listening, command: str, name: str, chunks: Chunks) -> Question:
    """Return the question about a stream; it always ends with a silence."""
    chunks = [*chunks, None]
    ask: Json = {
        "do": "stream",
        "direction": listening,
        "chunks": [None if chunk is None else hexed(chunk) for chunk in chunks],
    }
    return Question(f"stream/{name}", STREAM_FRAMES, command, ask, OurCodec(codec).ask(ask))


STREAMS = Group(
    "streams",
    (STREAM_FRAMES, STREAM_CHUNKS, STREAM_NOISE, NOISE_REASON),
    _streams,
    sends="Streams of frames, nested frames, damaged frames and noise, in chunks, with silences.",
    subject="each variant of each message, and random streams",
)
