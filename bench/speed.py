"""Compare the native codec with other programs, on the same input in the same run.

Each round runs each program once; a ratio is the median over the rounds. Bulk work is measured on a
large input, as captures are, and on a small one. An input is large if it has eight times the size
of the last-level cache; the first line of output compares the two sizes.
"""

from __future__ import annotations

import argparse
import re
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from rich.console import Console

import speed_peers as peers
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from speed_rows import ANGLES, BULK, MANY, OBJECTS, SINGLE, THREADS, Row, Streams
from speed_table import Ratio, Target, Timed, measure, ratios, show, untargeted, write_json
from streams import stream_a

# The frames that pymycobot reads in a round; its time is scaled to the whole stream.
SLOWEST = 2_000
MIB = 1 << 20

# The work by name, and the targets.
Part = tuple[dict[str, Row], list[Target]]


def main() -> None:
    """Measure and print; with --strict, exit with 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=256, help="of the large streams")
    parser.add_argument("--frames", type=int, default=1_000_000, help="of the small streams")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--rows", default="", help="only rows that match this expression")
    parser.add_argument("--json", type=Path, help="write the ratios to this file")
    parser.add_argument(
        "--streams", type=Path, help="keep the streams in this folder, and reuse them"
    )
    parser.add_argument("--strict", action="store_true", help="exit with 1 if a target was missed")
    options = parser.parse_args()
    console = Console(width=118)
    console.print(_caches(options.megabytes))
    with TemporaryDirectory() as temporary:
        folder = options.streams or Path(temporary)
        large, small = folder / "large", folder / "small"
        parts = {
            f"Bulk, {options.megabytes:g} MB": (bulk, large, options.megabytes),
            f"Bulk in two threads, {options.megabytes:g} MB": (bulk_in_two, large, 0),
            f"Bulk, {options.frames:,} frames": (bulk_small, small, options.frames * 15e-6),
            "Messages": (objects, small, 0),
            "One frame": (single, small, 0),
            "Adversarial input": (adversarial, small, 0),
            "Threads": (threads, large, 0),
        }
        found: list[Ratio] = []
        for title, (part, place, megabytes) in parts.items():
            if megabytes and not place.exists():
                place.mkdir()
                Streams.write(place, megabytes, options.frames)
            found += _measured(title, part(options.frames), Streams(place), options, console)
    if options.json:
        write_json(options.json, found)
    sys.exit(1 if options.strict and not all(row.met for row in found) else 0)


def _measured(
    title: str, part: Part, streams: Streams, options: argparse.Namespace, console: Console
) -> list[Ratio]:
    rows, targets = part
    wanted = [each for each in targets if re.search(options.rows, each.row)]
    codec = codecs.load(TABLE, "native")
    names = dict.fromkeys(name for each in wanted for name in (each.ours, each.peer))
    timed = {name: rows[name](codec, streams) for name in names}
    measure(timed, options.rounds)
    found = ratios(timed, wanted)
    if found:
        show(title, found, console)
    return found


def _caches(megabytes: float) -> str:
    """Compare the size of the input with that of the last cache, as far as Linux reports it."""
    sizes = Path("/sys/devices/system/cpu/cpu0/cache").glob("index*/size")
    last = max((int(each.read_text().strip().rstrip("K")) for each in sizes), default=0) / 1024
    if not last:
        return "The size of the last cache is unknown."
    times = megabytes * 1e6 / MIB / last
    enough = "" if times >= 8 else "; ratios on larger input can differ"
    return f"The last cache has {last:.0f} MiB, the large input {times:.1f} times that{enough}."


def _peers(frames: int) -> dict[str, Row]:
    """Return pymycobot on a pty; it reads few frames."""
    few = stream_a(TABLE, SLOWEST)
    scale = frames / SLOWEST
    return {
        "pymycobot": lambda *_: Timed(
            peers.pymycobot_reads(few.data, few.starts.tolist()), scale=scale
        ),
    }


def bulk(_: int) -> Part:
    """Time scans and columns of stream A, clean and with 10 % noise."""
    return BULK, [
        Target("framing scan to offsets", "scan", "memcpy", 1.7),
        Target("the same, 10 % noise", "noisy scan", "memcpy of the noisy stream", 3),
        Target("float64 columns, out=", "reused", "memcpy", 5),
        untargeted("float64 columns, fresh", "fresh", "memcpy", faster=False),
        Target("raw columns, out=", "raw", "memcpy", 3),
        untargeted(
            "raw columns, 10 % noise", "noisy raw", "memcpy of the noisy stream", faster=False
        ),
    ]


def bulk_in_two(_: int) -> Part:
    """Time the same with ``workers=2``, still against memcpy in one thread."""
    noisy = "memcpy of the noisy stream"
    return BULK, [
        untargeted("memcpy in two threads", "memcpy, two threads", "memcpy", faster=False),
        Target("framing scan to offsets, workers=2", "scan, two threads", "memcpy", 1.7),
        Target("the same, 10 % noise, workers=2", "noisy scan, two threads", noisy, 3),
        Target("float64 columns, out=, workers=2", "reused, two threads", "memcpy", 5),
        untargeted(
            "float64 columns, fresh, workers=2", "fresh, two threads", "memcpy", faster=False
        ),
        Target("raw columns, out=, workers=2", "raw, two threads", "memcpy", 3),
        untargeted(
            "raw columns, 10 % noise, workers=2", "noisy raw, two threads", noisy, faster=False
        ),
    ]


def bulk_small(frames: int) -> Part:
    """Time the same on input that fits into a cache, also against decoders in Python."""
    rows = {
        **BULK,
        **_peers(frames),
        "NumPy": lambda _, streams: Timed(partial(peers.numpy_columns, streams.clean)),
    }
    return rows, [
        untargeted("framing scan to offsets", "scan", "memcpy", faster=False),
        untargeted(
            "the same, 10 % noise", "noisy scan", "memcpy of the noisy stream", faster=False
        ),
        untargeted("float64 columns, out=", "reused", "memcpy", faster=False),
        untargeted("float64 columns, fresh", "fresh", "memcpy", faster=False),
        Target("float64 columns, fresh", "fresh", "NumPy", 10, faster=True),
        Target("float64 columns, fresh", "fresh", "pymycobot", 3000, faster=True),
        untargeted("raw columns, out=", "raw", "memcpy", faster=False),
        untargeted(
            "raw columns, 10 % noise", "noisy raw", "memcpy of the noisy stream", faster=False
        ),
    ]


def objects(frames: int) -> Part:
    """Time messages as Python objects."""
    rows = {
        **OBJECTS,
        **_peers(frames),
        "find": lambda _, streams: Timed(lambda: peers.FindDecoder(TABLE).feed(streams.few)),
    }
    return rows, [
        Target("lazy messages, a list", "list", "find", 35, faster=True),
        Target("lazy messages, each value read once", "iterated", "find", 12, faster=True),
        Target("lazy messages in 4 KiB chunks", "chunks", "pymycobot", 400, faster=True),
        Target("eager values, held in a list", "eager", "find", 7, faster=True),
        Target("eager values, held in a list", "eager", "pymycobot", 60, faster=True),
    ]


def single(_: int) -> Part:
    """Time one frame at a time."""

    def textbook(codec: Codec, _: Streams) -> Timed:
        frame, decoder = codec.encode("get_angles", "reply", (ANGLES,)), peers.FindDecoder(TABLE)
        return Timed(lambda: decoder.feed(frame), MANY)

    def theirs(codec: Codec, _: Streams) -> Timed:
        frame = codec.encode("get_angles", "reply", (ANGLES,))
        starts = range(0, SLOWEST * len(frame), len(frame))
        return Timed(peers.pymycobot_reads(frame * SLOWEST, starts), scale=1 / SLOWEST)

    rows = {
        **SINGLE,
        "find": textbook,
        "pymycobot": theirs,
        "floats": lambda *_: Timed(peers.six_floats(ANGLES), MANY),
        "struct": lambda *_: Timed(lambda: peers.struct_send_angles(ANGLES, 30), MANY),
        "pymycobot's building": lambda *_: Timed(peers.pymycobot_send_angles(ANGLES, 30), 1000),
    }
    return rows, [
        Target("feed() of one frame, eager", "feed", "find", 7, faster=True),
        Target("feed() of one frame, eager", "feed", "pymycobot", 90, faster=True),
        Target("feed() of one frame, eager", "feed", "a no-op call", 9),
        untargeted("  its list, tuple and floats alone", "floats", "a no-op call", faster=False),
        Target("encode send_angles", "encode", "struct", 6, faster=True),
        Target("encode send_angles", "encode", "pymycobot's building", 50, faster=True),
    ]


def adversarial(_: int) -> Part:
    """Time adversarial inputs of 64 MiB and of 32 MiB."""
    longest = TABLE.frame.maximum_length
    header = codecs.load(TABLE, "native").encode("get_angles", "reply", (ANGLES,))[:4]
    patterns = {
        "all FE": b"\xfe",
        "FE FE FF": b"\xfe\xfe\xff",
        "FE FE and the longest LEN": bytes([0xFE, 0xFE, longest]),
        "a legal header every 4 bytes": header,
    }

    def scanning(pattern: bytes, size: int) -> Row:
        times = size * MIB // len(pattern)
        return lambda codec, _: Timed(partial(codec.scan, pattern * times))

    rows: dict[str, Row] = {"memcpy": lambda *_: Timed(peers.memcpy(bytes(64 * MIB)))}
    targets = []
    for name, pattern in patterns.items():
        for size in (64, 32):
            rows[f"{name}, {size}"] = scanning(pattern, size)
        targets.append(Target(f"64 MiB of {name}", f"{name}, 64", "memcpy", 12))
        targets.append(Target("  and twice the input", f"{name}, 64", f"{name}, 32", 2.5))
    return rows, targets


def threads(_: int) -> Part:
    """Time two captures in two threads, and one after the other."""
    target = Target("two captures in two threads", "two", "one thread", 1.85, faster=True)
    return THREADS, [target]


if __name__ == "__main__":
    np.seterr(all="ignore")
    main()
