"""Make the captures of the tests of archives, and compare what exports wrote."""

from __future__ import annotations

import gzip
import random
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from capture.export.exporting import START, recording
from cobotwire.capture import Packet
from cobotwire.capture.export import ExportPlan, Inputs, Report, write
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.simulator.faults.noise import NOISE

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
COORDS = bytes.fromhex("FE FE 0E 23 01 BC FD A0 10 0D DC 66 FF 54 DE 21 FA")
FLAG = bytes.fromhex("FE FE 03 12 01 FA")
REJECTED = bytes.fromhex("FE FE 03 12 07 FA")
HEADER = bytes.fromhex("FE FE 0E 20")


def noisy_stream(frames: int, seed: int = 1) -> bytes:
    """Return replies of an arm with noise of every kind between and inside them."""
    draws = random.Random(seed)
    parts = []
    for _ in range(frames):
        axes = [draws.randint(-16000, 16000) for _ in range(6)]
        angles = b"".join(axis.to_bytes(2, "big", signed=True) for axis in axes)
        parts.append(HEADER + angles + b"\xfa")
        kind = draws.random()
        if kind < 0.05:
            parts.append(NOISE[draws.choice(list(NOISE))].draw(draws, TABLE))
        elif kind < 0.1:
            parts.append(ANGLES[: draws.randrange(1, 17)])
        elif kind < 0.2:
            parts.append(draws.choice([COORDS, FLAG, REJECTED]))
    return b"".join(parts)


def archive_in(folder: Path) -> Inputs:
    """Write a large raw file, a small one, an empty one, a compressed one and a recording."""
    (folder / "arm1.bin").write_bytes(noisy_stream(2000))
    (folder / "arm2.bin").write_bytes(noisy_stream(50, seed=2))
    (folder / "arm3.bin").write_bytes(b"")
    (folder / "arm4.bin.gz").write_bytes(gzip.compress(noisy_stream(200, seed=4)))
    sent = noisy_stream(150, seed=5)
    packets = (
        Packet(START + at * 10**6, "received", sent[at : at + 100], "bytes")
        for at in range(0, len(sent), 100)
    )
    recording(folder / "arm5.pcapng", packets, "mycobot280")
    return Inputs.find([str(folder)])


def plan(output: Path | str, **options: Any) -> ExportPlan:
    """Return the plan of an export of replies."""
    return ExportPlan(
        str(output), InstalledEditions("mycobot280"), **{"direction": "reply", **options}
    )


def on_one_machine(output: Path, inputs: Inputs, **options: Any) -> Report:
    """Export as ``cobotwire export`` does without an engine."""
    return write(plan(output, **options), inputs)


def rows(folder: Path) -> dict[str, Any]:
    """Return the rows of an export by message, in the order of its inputs and streams."""
    found: dict[str, list[Any]] = {}
    for path in sorted(folder.rglob("*.parquet")):
        found.setdefault(path.name.removesuffix(".parquet").partition("-")[0], []).append(
            _plain(pq.ParquetFile(path).read())
        )
    return {message: pa.concat_tables(tables) for message, tables in found.items()}


def _plain(table: Any) -> Any:
    """Return a table with plain texts: the order of dictionaries depends on the pieces."""
    names = [name for name in ("robot", "source") if name in table.column_names]
    for name in names:
        place = table.column_names.index(name)
        table = table.set_column(place, name, table.column(name).cast(pa.utf8()))
    return table


def counts(report: Report) -> dict[str, Any]:
    """Return a report without its files, which depend on the pieces, and the names of inputs."""
    found = {key: value for key, value in report.as_dict().items() if key != "files"}
    return {**found, "unread": len(report.unread)}
