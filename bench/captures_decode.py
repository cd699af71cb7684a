"""Measure ``cobotwire decode`` on large captures: summaries against the scan, lines against Python.

The peer of the lines is the decoding frame by frame, which the program used for all input before,
and still uses for the reference codec. It reads a small part, and its time is scaled.
"""

from __future__ import annotations

import os
from contextlib import redirect_stdout
from functools import partial
from pathlib import Path

from cobotwire import codec as codecs
from cobotwire.capture.byte_source import open_bytes
from cobotwire.cli.shared import decoded_bytes
from cobotwire.cli.shared.stream_printer import DecodeOptions
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.editions.mycobot280 import TABLE
from damage import noisy
from speed_table import Target, Timed
from streams import stream_a

# The frames of stream A that a capture repeats, and those that Python reads one by one.
FRAMES = 500_000
FEW = 20_000
OPTIONS = DecodeOptions("mycobot280", "both", False, False, True, False)


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
            f"{kind} scan": Timed(partial(codecs.load(TABLE, "native").scan, data)),
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
        source = open_bytes([path], "raw", lambda text: None)
        decoded_bytes.decode_bytes(source, options, StreamCounts())


def _frame_by_frame(path: str) -> None:
    codec = codecs.load(TABLE, "native")
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere):
        source = open_bytes([path], "raw", lambda text: None)
        decoded_bytes.diagnose_bytes(codec, source, OPTIONS, StreamCounts())
