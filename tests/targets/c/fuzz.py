"""Compare the C code with our codec on random streams for some seconds; not part of the tests.

    PYTHONPATH=tests .venv/bin/python tests/targets/c/fuzz.py 60

It prints how many streams gave the same frames and messages, and ends at the first difference.
"""

from __future__ import annotations

import random
import sys
import time

import vectors
from cobotwire.codec.interface import Frame, Listening
from strategies import TABLES, codec_of
from targets.c.comparison import joined
from targets.c.compiled import program
from targets.c.ours import CodecSide, events
from targets.c.peer import CPeer
from targets.vectors.comparison import read

FLAGS = ("-g", "-O2", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
LISTENING: tuple[Listening, ...] = ("request", "reply", "both")
NOISE = (b"\xfe", b"\xfe\xfe", b"\xfa", b"\xff\xff\x01\x04\x02\x38\x02\xbe", b"cmd_len error\r\n")


def stream(chance: random.Random, frames: list[bytes]) -> bytes:
    """Return frames, some damaged and some cut, with noise between them."""
    made = bytearray()
    for _ in range(chance.randrange(1, 9)):
        piece = bytearray(chance.choice(frames))
        match chance.randrange(6):
            case 0:
                piece[chance.randrange(len(piece))] = chance.choice((0xFE, 0xFA, 0x02, 0x20, 0x0E))
            case 1:
                del piece[chance.randrange(len(piece))]
            case 2:
                piece = piece[: chance.randrange(len(piece))]
            case 3:
                made += chance.choice(NOISE) + chance.randbytes(chance.randrange(4))
        made += piece
    return bytes(made)


def differs(chance: random.Random, frames: list[bytes], ours: CodecSide, peer: CPeer) -> str:
    """Frame one stream with both, cut and flushed anywhere; return the difference, if any."""
    data, listening = stream(chance, frames), chance.choice(LISTENING)
    cuts = sorted(chance.randrange(len(data) + 1) for _ in range(chance.randrange(5)))
    chunks = [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)])]
    flushes = [chance.random() < 0.2 for _ in chunks]
    framer = ours.codec.framer(listening)
    right = []
    for chunk, flush in zip(chunks, flushes):
        right += framer.feed(chunk) + (framer.flush() if flush else [])
    found, pending = peer.events(listening, list(zip(chunks, flushes)))
    summary = f"{data.hex(' ')}, {listening}, cut at {cuts}, flushed {flushes}"
    if joined(found) != joined(list(events(right))) or pending != framer.pending:
        return f"framed differently: {summary}"
    for event in right:
        if not isinstance(event, Frame):
            continue
        if ours.read_in_c(peer.read(listening, event.data)) != ours.event(event):
            return f"read differently: {event.data.hex(' ')} of {summary}"
    return ""


def main() -> int:
    """Take the editions in turn until the time is over."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    chance = random.Random()
    for edition in sorted(TABLES):
        document = read(edition)
        frames = [bytes.fromhex(r["bytes"]) for r in document["messages"] + document["malformed"]]
        frames = [frame for frame in frames if frame]
        ours = CodecSide(vectors.edition(edition), codec_of(edition, "native"))
        with CPeer(program(vectors.edition(edition), "gcc", FLAGS, f"fuzz-{edition}")) as peer:
            count, end = 0, time.monotonic() + seconds / len(TABLES)
            while time.monotonic() < end:
                if found := differs(chance, frames, ours, peer):
                    print(f"{edition}: stream {count}: {found}")
                    return 1
                count += 1
        print(f"{edition}: {count:,} streams gave equal results")
    return 0


if __name__ == "__main__":
    sys.exit(main())
