"""Measure ``cobotwire decode`` on large captures.

Summaries are compared with the scan, which reuses its memory, so that it clears no pages. Lines are
compared with decoding frame by frame, as for the reference codec. Frame by frame, only a small part
of the file is decoded, and the time is scaled. Each round runs each program once; a ratio is the
median of the ratios of all rounds.
"""

from __future__ import annotations

import argparse
import os
import sys
from contextlib import redirect_stdout
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console

from cobotwire import codec as codecs
from cobotwire.capture.byte_source import ByteSource, open_input
from cobotwire.cli.shared import decoded_bytes
from cobotwire.cli.shared.stream_printer import DecodeOptions
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.editions.mycobot280 import TABLE
from damage import noisy
from speed_rows import Reused
from speed_table import Target, Timed, measure, ratios, show
from streams import stream_a

# The frames of stream A that a capture repeats, and those that Python reads one by one.
FRAMES = 500_000
FEW = 20_000
OPTIONS = DecodeOptions("mycobot280", "both", False, False, True, False)


def main() -> None:
    """Measure and print; with --strict, exit with 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=int, default=256, help="the size of a capture")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--strict", action="store_true", help="exit with 1 if a target was missed")
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        timed, targets = decode(Path(folder), options.megabytes)
        measure(timed, options.rounds)
    rows = ratios(timed, targets)
    show("cobotwire decode", rows, Console(width=118))
    sys.exit(1 if options.strict and not all(row.met for row in rows) else 0)


def decode(folder: Path, megabytes: int) -> tuple[dict[str, Timed], list[Target]]:
    """Time summaries and lines of stream A, clean and with 10 % noise."""
    timed: dict[str, Timed] = {}
    for kind in ("clean", "noisy"):
        line, few = stream_a(TABLE, FRAMES), stream_a(TABLE, FEW)
        if kind == "noisy":
            line, few = noisy(TABLE, line), noisy(TABLE, few)
        data = line.data * max(1, megabytes * 1_000_000 // len(line.data))
        (folder / f"{kind}.bin").write_bytes(data)
        (folder / f"{kind}-few.bin").write_bytes(few.data)
        (folder / f"{kind}-some.bin").write_bytes(line.data)
        path, some = str(folder / f"{kind}.bin"), str(folder / f"{kind}-some.bin")
        timed |= {
            f"{kind} scan": Timed(Reused(partial(codecs.load(TABLE, "native").scan, data))),
            f"{kind} summary": Timed(partial(_decode, path, OPTIONS._replace(quiet=True))),
            f"{kind} lines": Timed(partial(_decode, some, OPTIONS)),
            f"{kind} frame by frame": Timed(
                partial(_frame_by_frame, str(folder / f"{kind}-few.bin")),
                scale=len(line.data) / len(few.data),
            ),
        }
    return timed, [
        Target("decode --summary", "clean summary", "clean scan", 5),
        Target("the same, 10 % noise", "noisy summary", "noisy scan", 5),
        Target("decode --json", "clean lines", "clean frame by frame", 20, faster=True),
        Target("the same, 10 % noise", "noisy lines", "noisy frame by frame", 20, faster=True),
    ]


def _decode(path: str, options: DecodeOptions) -> None:
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere):
        source = open_input([path], "raw", print)
        assert isinstance(source, ByteSource), "raw bytes are not a recording"
        decoded_bytes.decode_bytes(source, options, StreamCounts())


def _frame_by_frame(path: str) -> None:
    codec = codecs.load(TABLE, "native")
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere):
        source = open_input([path], "raw", print)
        assert isinstance(source, ByteSource), "raw bytes are not a recording"
        decoded_bytes.diagnose_bytes(codec, source, OPTIONS, StreamCounts())


if __name__ == "__main__":
    main()
