"""Trials of streams: frames among noise, in chunks, with silences; the law of framing, asked."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from itertools import pairwise

from cobotwire.codec.interface import Codec, Event, Listening, Noise
from cobotwire.conformance.codec.trials.frames import Form, forms_of, hexed, ordinary_frame
from cobotwire.conformance.codec.trials.malformed import damages
from cobotwire.conformance.codec.trials.trial import Json, Trial
from cobotwire.table import Table

# None: the line is silent, and the framer must decide what it still waits with.
Chunks = Sequence[bytes | None]

LISTENING: tuple[Listening, ...] = ("request", "reply", "both")
NOISES = (
    bytes.fromhex("FF FF 01 04 02 38 02 BE"),  # a servo packet
    bytes.fromhex("FF FF 01 04 00 BB 3D FE"),  # one whose checksum looks like a header's beginning
    b"cmd_len error\r\n",
    bytes(9),
    bytes.fromhex("78 80 78"),
    bytes.fromhex("FA FA"),
)
RANDOM_STREAMS = 240


def streams(codec: Codec) -> Iterator[Trial]:
    """All of them."""
    forms = list(forms_of(codec.table))
    sizes: set[tuple[str, int]] = set()
    for form in forms:
        yield from _of_form(codec, form)
        # What silence does depends on where a frame ends, not on whose it is.
        if (form.direction, form.layout.size) not in sizes:
            sizes.add((form.direction, form.layout.size))
            yield from _silences(codec, form)
    for listening in LISTENING:
        heard = [form for form in forms if listening in (form.direction, "both")]
        yield from _inside_each_other(codec, listening, heard)
        for seed in range(RANDOM_STREAMS):
            yield _random(codec, listening, heard, seed)


def _of_form(codec: Codec, form: Form) -> Iterator[Trial]:
    whole = ordinary_frame(codec.table, form)
    after = ordinary_frame(codec.table, form, turn=7)

    def trial(name: str, chunks: Chunks) -> Trial:
        return stream(codec, form.direction, form.command.name, f"{form.label}/{name}", chunks)

    yield trial("alone", [whole])
    yield trial("byte-by-byte", [bytes([byte]) for byte in whole + after])
    yield trial("silence-inside", [whole[:-1], None, whole[-1:], after])
    for name, broken in damages(codec.table, whole):
        yield trial(f"{name}-then-whole", [broken + after])
    for index, noise in enumerate(NOISES):
        yield trial(f"noise-{index}", [noise + whole + noise + after + noise])
    for count in range(1, 5):
        yield trial(f"header-bytes-{count}", [codec.table.frame.header[:1] * count + whole])


def _silences(codec: Codec, form: Form) -> Iterator[Trial]:
    """A silence before the next frame: what was cut must not claim it."""
    whole = ordinary_frame(codec.table, form)
    after = ordinary_frame(codec.table, form, turn=7)
    for name, broken in damages(codec.table, whole):
        place = f"{form.label}/{name}-silence-then-whole"
        yield stream(codec, form.direction, form.command.name, place, [broken, None, after])


def _inside_each_other(
    codec: Codec, listening: Listening, forms: Sequence[Form]
) -> Iterator[Trial]:
    """False headers of each legal kind in front of true frames, complete by chance and not."""
    table = codec.table
    short = min((ordinary_frame(table, form) for form in forms), key=len)
    heads = {ordinary_frame(table, form)[: table.frame.overhead + 1] for form in forms}
    longest = table.frame.overhead + table.frame.maximum_length
    for head in sorted(heads):
        for name, behind in (
            ("one", short),
            ("many", short * (longest // len(short) + 2)),
            ("footers", short + table.frame.footer * longest),
        ):
            place = f"any/{listening}/false-{head.hex().upper()}-{name}"
            yield stream(codec, listening, "", place, [head + behind])
            yield stream(codec, listening, "", f"{place}-chunked", cut(head + behind, 3))


def _random(codec: Codec, listening: Listening, forms: Sequence[Form], seed: int) -> Trial:
    """A stream of pieces of all kinds, cut anywhere; the seed makes it the same every time."""
    chance = random.Random(f"{listening} {seed}")  # noqa: S311  (no secret; it must repeat)
    data = b"".join(_piece(codec.table, forms, chance) for _ in range(chance.randint(2, 9)))
    cuts = sorted(chance.randint(0, len(data)) for _ in range(chance.randint(0, 6)))
    chunks: list[bytes | None] = []
    for start, end in pairwise([0, *cuts, len(data)]):
        chunks.append(data[start:end])
        if chance.random() < 0.15:
            chunks.append(None)
    return stream(codec, listening, "", f"any/{listening}/random-{seed}", chunks)


def _piece(table: Table, forms: Sequence[Form], chance: random.Random) -> bytes:
    whole = ordinary_frame(table, chance.choice(forms), chance.randint(0, 9))
    kind = chance.randint(0, 6)
    if kind == 0:
        return chance.choice(NOISES)
    if kind == 1:
        return whole[: chance.randint(1, len(whole))]
    if kind == 2:
        index = chance.randrange(len(whole))
        return whole[:index] + bytes([chance.randint(0, 255)]) + whole[index + 1 :]
    if kind == 3:
        return bytes(
            chance.choice(b"\xfe\xfa\x02\x0e\x20\x00") for _ in range(chance.randint(1, 9))
        )
    return whole


def cut(data: bytes, size: int) -> list[bytes]:
    """``data`` in pieces of ``size`` bytes."""
    return [data[at : at + size] for at in range(0, len(data), size)]


def stream(codec: Codec, listening: Listening, command: str, name: str, chunks: Chunks) -> Trial:
    """The trial of a stream; a silence stands behind it in any case."""
    chunks = [*chunks, None]
    framer = codec.framer(listening)
    events = [
        [_told(event) for event in (framer.flush() if chunk is None else framer.feed(chunk))]
        for chunk in chunks
    ]
    ask: Json = {
        "do": "stream",
        "direction": listening,
        "chunks": [None if chunk is None else hexed(chunk) for chunk in chunks],
    }
    return Trial(f"stream/{name}", "stream-frames", command, ask, {"events": events})


def _told(event: Event) -> Json:
    kind = "noise" if isinstance(event, Noise) else "frame"
    told: Json = {kind: hexed(event.data), "offset": event.offset}
    return {**told, "reason": event.reason} if isinstance(event, Noise) else told
