"""Compare the native codec with other programs, on the same input in the same run.

Each round runs each program once; a ratio is the median over the rounds.
"""

from __future__ import annotations

import argparse
import sys
import threading
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

import speed_peers as peers
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Columns, Noise, Scan
from cobotwire.editions.mycobot280 import TABLE
from damage import noisy
from speed_table import Ratio, Target, Timed, measure, ratios, show, untargeted, write_json
from streams import stream_a

ANGLES = [1.5, -20.25, 30.0, 0.01, 0.29, -179.99]
CHUNK = 4096
# The frames that pymycobot reads in a round; its time is scaled to the whole stream.
SLOWEST = 2_000
MIB = 1 << 20


def main() -> None:
    """Measure and print; with --strict, exit with 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=1_000_000, help="of stream A")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--json", type=Path, help="write the ratios to this file")
    parser.add_argument("--strict", action="store_true", help="exit with 1 if a target was missed")
    options = parser.parse_args()
    codec = codecs.load(TABLE, "native")
    console = Console(width=118)
    found: list[Ratio] = []
    for title, part in PARTS.items():
        timed, targets = part(codec, options.frames)
        measure(timed, options.rounds)
        rows = ratios(timed, targets)
        show(title, rows, console)
        found += rows
    if options.json:
        write_json(options.json, found)
    sys.exit(1 if options.strict and not all(row.met for row in found) else 0)


class Reused:
    """Pass the previous result as ``out=``, like a program that reads many captures."""

    def __init__(self, call: Any) -> None:
        self.call = call
        self.last: Scan | Columns | None = None

    def __call__(self) -> object:
        """Call once more."""
        self.last = self.call(out=self.last)
        return self.last


def bulk(codec: Codec, frames: int) -> tuple[dict[str, Timed], list[Target]]:
    """Time scans and columns of stream A, clean and with 10 % noise."""
    line = stream_a(TABLE, frames)
    clean, bad = line.data, noisy(TABLE, line).data
    few = stream_a(TABLE, SLOWEST)
    timed = {
        "memcpy": Timed(peers.memcpy(clean)),
        "memcpy of the noisy stream": Timed(peers.memcpy(bad)),
        "scan": Timed(Reused(partial(codec.scan, clean, "reply"))),
        "noisy scan": Timed(Reused(partial(codec.scan, bad, "reply"))),
        "fresh": Timed(partial(codec.decode_columns, clean, "reply")),
        "reused": Timed(Reused(partial(codec.decode_columns, clean, "reply"))),
        "raw": Timed(Reused(partial(codec.decode_columns, clean, "reply", raw=True))),
        "noisy raw": Timed(Reused(partial(codec.decode_columns, bad, "reply", raw=True))),
        "NumPy": Timed(partial(peers.numpy_columns, clean)),
        "pymycobot": Timed(
            peers.pymycobot_reads(few.data, few.starts.tolist()), scale=frames / SLOWEST
        ),
        "pymycobot, no port": Timed(peers.pymycobot_reads_memory(few.data), scale=frames / SLOWEST),
    }
    return timed, [
        Target("framing scan to offsets", "scan", "memcpy", 1.6),
        Target("the same, 10 % noise", "noisy scan", "memcpy of the noisy stream", 2.5),
        Target("float64 columns, out=", "reused", "memcpy", 6.5),
        Target("float64 columns, fresh", "fresh", "memcpy", 8),
        Target("float64 columns, fresh", "fresh", "NumPy", 10, faster=True),
        Target("float64 columns, fresh", "fresh", "pymycobot", 3000, faster=True),
        untargeted("float64 columns, fresh", "fresh", "pymycobot, no port"),
        Target("raw columns, out=", "raw", "memcpy", 2.5),
        Target("the same, 10 % noise", "noisy raw", "memcpy of the noisy stream", 3),
    ]


def objects(codec: Codec, frames: int) -> tuple[dict[str, Timed], list[Target]]:
    """Time messages as Python objects."""
    data = stream_a(TABLE, frames).data
    few = stream_a(TABLE, SLOWEST)

    def iterated() -> None:
        for frame in _frames(codec, data):
            frame.values  # noqa: B018  (reading it is the work)

    def in_chunks() -> None:
        framer = codec.framer("reply")
        for start in range(0, len(data), CHUNK):
            framer.feed(data[start : start + CHUNK])

    def eager() -> list[Any]:
        return [frame.values for frame in codec.framer("reply").feed(data)]  # type: ignore[union-attr]

    timed = {
        "find": Timed(lambda: peers.FindDecoder(TABLE).feed(data)),
        "pymycobot": Timed(
            peers.pymycobot_reads(few.data, few.starts.tolist()), scale=frames / SLOWEST
        ),
        "pymycobot, no port": Timed(peers.pymycobot_reads_memory(few.data), scale=frames / SLOWEST),
        "list": Timed(lambda: codec.framer("reply").feed(data)),
        "iterated": Timed(iterated),
        "chunks": Timed(in_chunks),
        "eager": Timed(eager),
    }
    return timed, [
        Target("lazy messages, a list", "list", "find", 35, faster=True),
        Target("lazy messages, each value read once", "iterated", "find", 12, faster=True),
        Target("lazy messages in 4 KiB chunks", "chunks", "pymycobot", 400, faster=True),
        untargeted("lazy messages in 4 KiB chunks", "chunks", "pymycobot, no port"),
        Target("eager values, held in a list", "eager", "find", 7, faster=True),
        Target("eager values, held in a list", "eager", "pymycobot", 60, faster=True),
    ]


def _frames(codec: Codec, data: bytes) -> Any:
    """Yield all frames of a buffer block by block, so that memory stays small."""
    framer = codec.framer("reply")
    for start in range(0, len(data), 1 << 16):
        for event in framer.feed(data[start : start + (1 << 16)]):
            if not isinstance(event, Noise):
                yield event


def single(codec: Codec, frames: int) -> tuple[dict[str, Timed], list[Target]]:
    """Time one frame at a time."""
    frame = codec.encode("get_angles", "reply", (ANGLES,))
    framer = codec.framer("reply")
    textbook = peers.FindDecoder(TABLE)
    values = (ANGLES, 30)
    many = 20_000
    timed = {
        "a no-op call": Timed(lambda: None, many),
        "find": Timed(lambda: textbook.feed(frame), many),
        "pymycobot": Timed(
            peers.pymycobot_reads(frame * SLOWEST, range(0, SLOWEST * len(frame), len(frame))),
            scale=1 / SLOWEST,
        ),
        "feed": Timed(lambda: framer.feed(frame)[0].values, many),  # type: ignore[union-attr]
        "encode": Timed(lambda: codec.encode("send_angles", "request", values), many),
        "struct": Timed(lambda: peers.struct_send_angles(ANGLES, 30), many),
        "pymycobot's building": Timed(peers.pymycobot_send_angles(ANGLES, 30), 1000),
    }
    return timed, [
        Target("feed() of one frame, eager", "feed", "find", 7, faster=True),
        Target("feed() of one frame, eager", "feed", "pymycobot", 90, faster=True),
        Target("feed() of one frame, eager", "feed", "a no-op call", 10),
        Target("encode send_angles", "encode", "struct", 8, faster=True),
        Target("encode send_angles", "encode", "pymycobot's building", 50, faster=True),
    ]


def adversarial(codec: Codec, frames: int) -> tuple[dict[str, Timed], list[Target]]:
    """Time adversarial inputs of 64 MiB and of 32 MiB."""
    longest = TABLE.frame.maximum_length
    header = codec.encode("get_angles", "reply", (ANGLES,))[:4]
    patterns = {
        "all FE": b"\xfe",
        "FE FE FF": b"\xfe\xfe\xff",
        "FE FE and the longest LEN": bytes([0xFE, 0xFE, longest]),
        "a legal header every 4 bytes": header,
    }
    timed = {"memcpy": Timed(peers.memcpy(bytes(64 * MIB)))}
    targets = []
    for name, pattern in patterns.items():
        for size in (64, 32):
            data = pattern * (size * MIB // len(pattern))
            timed[f"{name}, {size}"] = Timed(partial(codec.scan, data))
        targets.append(Target(f"64 MiB of {name}", f"{name}, 64", "memcpy", 12))
        targets.append(Target("  and twice the input", f"{name}, 64", f"{name}, 32", 2.5))
    return timed, targets


def threads(codec: Codec, frames: int) -> tuple[dict[str, Timed], list[Target]]:
    """Time two captures in two threads, and one after the other."""
    data = stream_a(TABLE, 4 * frames).data
    out: list[Columns | None] = [None, None]

    def read(place: int) -> None:
        out[place] = codec.decode_columns(data, "reply", out=out[place])

    def together() -> None:
        both = [threading.Thread(target=read, args=(place,)) for place in (0, 1)]
        for thread in both:
            thread.start()
        for thread in both:
            thread.join()

    def in_turn() -> None:
        read(0)
        read(1)

    timed = {"one thread": Timed(in_turn), "two": Timed(together)}
    return timed, [Target("two captures in two threads", "two", "one thread", 1.8, faster=True)]


PARTS = {
    "Bulk": bulk,
    "Messages": objects,
    "One frame": single,
    "Adversarial input": adversarial,
    "Threads": threads,
}

if __name__ == "__main__":
    np.seterr(all="ignore")
    main()
