"""Measure what the machine allows for bulk work, with programs that decode nothing.

The first table has the memory traffic alone: read a capture, and write as much as each result. A
scan writes 8 bytes for each frame, columns write the values too. This is a floor for any program
that reads and writes as much, as far as reading and writing do not overlap.

The second table compares two threads with the same work in turn: memcpy, SHA-256, which needs
little memory traffic, and columns. None holds the interpreter's lock. Where other programs run too,
start it with real-time priority: ``chrt --fifo 1 python bench/bulk_floor.py``.
"""

from __future__ import annotations

import argparse
import hashlib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from rich.console import Console

import speed_peers as peers
from cobotwire import codec as codecs
from cobotwire.codec.interface import Columns
from cobotwire.editions.mycobot280 import TABLE
from speed_rows import Reused, Streams, in_turn, together
from speed_table import Ratio, Timed, measure, ratios, show, untargeted


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=256)
    parser.add_argument("--rounds", type=int, default=9)
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        data = Streams.write(Path(folder), options.megabytes, 1_000).clean
    console = Console(width=118)
    title = f"Memory traffic alone, {len(data) / 1e6:.0f} MB"
    show(title, floors(data, options.rounds), console)
    show("Two threads", threads(data, options.rounds), console)


def floors(data: bytes, rounds: int) -> list[Ratio]:
    """Return the time of reading the input and writing each result, against memcpy."""
    codec = codecs.load(TABLE, "native")
    sizes = {
        "a scan": codec.scan(data, "reply").offset.nbytes,
        "raw columns": _bytes(codec.decode_columns(data, "reply", raw=True)),
        "float64 columns": _bytes(codec.decode_columns(data, "reply")),
    }
    timed = {"memcpy": Timed(peers.memcpy(data))}
    for name, size in sizes.items():
        timed[name] = Timed(partial(_touch, np.frombuffer(data, np.uint8), np.zeros(size // 8)))
    measure(timed, rounds)
    targets = [
        untargeted(
            f"read, and write {sizes[name] / 1e6:.0f} MB as {name}", name, "memcpy", faster=False
        )
        for name in sizes
    ]
    return ratios(timed, targets)


def threads(data: bytes, rounds: int) -> list[Ratio]:
    """Return how many times faster two threads are than the same work in turn."""
    codec = codecs.load(TABLE, "native")
    works: dict[str, list[Callable[[], object]]] = {
        "memcpy": [peers.memcpy(data), peers.memcpy(data)],
        "SHA-256": [partial(hashlib.sha256, data)] * 2,
        "float64 columns": [
            Reused(partial(codec.decode_columns, data, "reply")),
            Reused(partial(codec.decode_columns, data, "reply")),
        ],
    }
    timed = {}
    for name, both in works.items():
        timed[name] = Timed(partial(together, both))
        timed[f"{name} in turn"] = Timed(partial(in_turn, both))
    measure(timed, rounds)
    return ratios(timed, [untargeted(name, name, f"{name} in turn") for name in works])


def _bytes(columns: Columns) -> int:
    """Return the size of all columns."""
    each = (rows.offset.nbytes + sum(rows[name].nbytes for name in rows.names) for rows in columns)
    return sum(each)


def _touch(source: np.ndarray[Any, Any], target: np.ndarray[Any, Any]) -> None:
    """Read all of the source, and write all of the target."""
    source[: len(source) // 8 * 8].view(np.uint64).sum()
    target.fill(1.0)


if __name__ == "__main__":
    main()
