"""Compare reading recordings into columns with decoding the same bytes without times.

Compare exports with pyarrow, which writes tables that are already in memory.

The recording is a polled arm: a request and its reply, 100 times a second. Each round runs each
program once; a ratio is the median over the rounds. The file is larger than the L3 cache of most
machines (`--polls` makes it larger).
"""

from __future__ import annotations

import argparse
import gzip
import os
import sys
import tempfile
import zlib
from collections.abc import Callable, Sequence
from functools import partial
from itertools import islice
from mmap import ACCESS_READ, mmap
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow.parquet as pq
from rich.console import Console

from cobotwire import codec as codecs
from cobotwire.capture import block_encoding as blocks
from cobotwire.capture import read
from cobotwire.capture.columns import read_batches, read_columns
from cobotwire.capture.export import ExportPlan, Inputs, write
from cobotwire.capture.export.formats.parquet_file import settings
from cobotwire.capture.export.output import BLOCK_ROWS
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.inspect.captured import messages
from cobotwire.inspect.exporting import InstalledEditions
from speed_table import Ratio, Target, Timed, measure, ratios, show, untargeted, write_json

REQUEST = bytes.fromhex("FE FE 02 20 FA")
# Messages that the Python reader takes in a round; its time is scaled to the whole file.
SLOWEST = 5_000
# The size of the raw bytes to export, larger than the cache.
EXPORTED = 256_000_000
POLL_NS = 10_000_000
START_NS = 1_700_000_000_000_000_000
PLAIN = "decode_columns without times"
PYTHON = "messages() of the Python reader"


class Recording(NamedTuple):
    """A recording on disk, and its bytes by direction."""

    path: Path
    sent: bytes
    received: bytes
    polls: int


def main() -> None:
    """Measure and print; with --strict, exit with 1 if a target was missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--polls", type=int, default=2_500_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, help="write the ratios to this file")
    parser.add_argument("--strict", action="store_true", help="exit with 1 if a target was missed")
    options = parser.parse_args()
    found: list[Ratio] = []
    with tempfile.TemporaryDirectory() as folder:
        recording = polled(Path(folder) / "polled.pcapng", options.polls)
        codec = codecs.load(TABLE, "native")
        size = recording.path.stat().st_size / 1e6
        for title, part in PARTS.items():
            timed, targets = part(codec, recording)
            measure(timed, options.rounds)
            rows = ratios(timed, targets)
            show(f"{title}, {size:,.0f} MB", rows, Console(width=118))
            found += rows
    if options.json:
        write_json(options.json, found)
    sys.exit(1 if options.strict and not all(row.met for row in found) else 0)


def polled(path: Path, polls: int) -> Recording:
    """Write the recording of an arm that is polled for its angles."""
    rng = np.random.default_rng(1)
    replies = np.tile(np.frombuffer(bytes.fromhex("FEFE0E20" + 24 * "0" + "FA"), "u1"), (polls, 1))
    angles = rng.integers(-9000, 9000, (polls, 6)).astype(">i2")
    replies[:, 4:16] = angles.view("u1").reshape(polls, 12)
    one = [
        blocks.packet(0, 0, REQUEST, blocks.OUTBOUND, ""),
        blocks.packet(0, 0, replies[0].tobytes(), blocks.INBOUND, ""),
    ]
    both = np.tile(np.frombuffer(b"".join(one), "u1"), (polls, 1))
    times = START_NS + np.arange(polls, dtype=np.int64) * POLL_NS
    reply = len(one[0])
    for start, late in ((0, 0), (reply, 4_000_000)):
        stamps = np.stack([(times + late) >> 32, (times + late) & 0xFFFFFFFF], axis=1)
        both[:, start + 12 : start + 20] = stamps.astype("<u4").view("u1").reshape(polls, 8)
    both[:, reply + 28 : reply + 45] = replies
    with path.open("wb") as file:
        file.write(blocks.section("cobotwire"))
        file.write(blocks.interface("/dev/ttyACM0", "edition mycobot280", 115200))
        both.tofile(file)
        file.write(blocks.statistics(0, START_NS, int(times[-1]), 2 * polls))
    return Recording(path, REQUEST * polls, replies.tobytes(), polls)


Part = tuple[dict[str, Timed], Sequence[Target]]


def columns(codec: Codec, recording: Recording) -> Part:
    """Measure reading a recording into columns."""

    def without_times() -> object:
        return (
            codec.decode_columns(recording.sent, "request"),
            codec.decode_columns(recording.received, "reply"),
        )

    def mapped() -> None:
        with recording.path.open("rb") as file, mmap(file.fileno(), 0, access=ACCESS_READ) as data:
            read_columns(data, codec)

    def batches() -> int:
        return sum(len(batch.streams) for batch in read_batches(recording.path, codec))

    def python_reader() -> int:
        return sum(1 for _ in islice(messages(read(recording.path)), SLOWEST))

    timed = {
        PLAIN: Timed(without_times),
        PYTHON: Timed(python_reader, scale=2 * recording.polls / SLOWEST),
        "file": Timed(partial(read_columns, recording.path, codec)),
        "mmap": Timed(mapped),
        "batches": Timed(batches),
    }
    return timed, [
        Target("pcapng to columns with times", "file", PLAIN, 3),
        Target("the same, from an mmap", "mmap", PLAIN, 3),
        Target("the same, in batches of 4 MiB", "batches", PLAIN, 3),
        Target("pcapng to columns with times", "file", PYTHON, 100, faster=True),
    ]


def compressed(codec: Codec, recording: Recording) -> Part:
    """Measure what decompression adds."""
    path = recording.path.with_suffix(".pcapng.gz")
    with gzip.open(path, "wb", compresslevel=1) as file:
        file.write(recording.path.read_bytes()[: 1 << 25])

    def inflate() -> None:
        zlib.decompress(path.read_bytes(), wbits=31)

    timed = {
        "zlib.decompress": Timed(inflate),
        "gz": Timed(partial(read_columns, path, codec)),
    }
    return timed, [untargeted("32 MiB of .pcapng.gz to columns", "gz", "zlib.decompress")]


def exported(codec: Codec, recording: Recording) -> Part:
    """Measure exports of raw bytes and of the recording, on one core."""
    raw = recording.path.with_name("received.bin")
    with raw.open("wb") as file:
        for _ in range(EXPORTED // len(recording.received)):
            file.write(recording.received)
    return _exports(recording.path.parent, {"raw bytes": raw, "recording": recording.path})


def _exports(folder: Path, inputs: dict[str, Path]) -> tuple[dict[str, Timed], Sequence[Target]]:
    """Time the export of captures to Parquet, and pyarrow on the same tables, on one core."""
    timed: dict[str, Timed] = {}
    targets = []
    for number, (name, path) in enumerate(inputs.items()):
        out = folder / f"out {number}"
        plan = ExportPlan(str(out), InstalledEditions(), direction="reply", overwrite=True)
        found = Inputs.find([str(path)])
        write(plan, found)
        ready = {path: pq.read_table(path) for path in sorted(out.iterdir())}
        peer = f"pyarrow, ready tables of the {name}"
        timed[name] = Timed(partial(_on_one_core, partial(write, plan, found)))
        timed[peer] = Timed(partial(_on_one_core, partial(_write_ready, plan, ready)))
        targets.append(Target(f"{name} to Parquet", name, peer, 2))
    return timed, targets


def _write_ready(plan: ExportPlan, tables: dict[Path, Any]) -> None:
    for path, table in tables.items():
        with pq.ParquetWriter(path, table.schema, **settings(plan, table.schema)) as writer:
            writer.write_table(table, row_group_size=BLOCK_ROWS)


def _on_one_core(work: Callable[[], object]) -> None:
    """Run work on one core, so that neither program gains by threads."""
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(cores)})
    try:
        work()
    finally:
        os.sched_setaffinity(0, cores)


PARTS = {
    "recordings to columns": columns,
    "compressed recordings": compressed,
    "exports, one core": exported,
}

if __name__ == "__main__":
    main()
