"""Report which frames each reader finds on damaged lines.

Every undamaged frame must be found, unless a false frame that the table allows covers it. Covered
frames are counted and shown. If any other frame is lost, or the two codecs differ, the exit code
is 1.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import readers
import resync_table
import streams
from cobotwire import codec as codecs
from cobotwire.codec.interface import Listening
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.table import Table
from damage import KINDS, damage, noisy
from readers import Reader
from scoring import as_json, ideal_distances, score, spread
from streams import Line

TABLES = {table.edition: table for table in (TABLE, TABLE_280)}
# How many times as long a line is, by the rate of damage: rare damage needs longer lines.
LENGTHS = {1e-4: 2.0, 1e-3: 1.0, 1e-2: 0.5}
BYTE_BY_BYTE = 100_000


@dataclass(frozen=True)
class Scenario:
    """One row: a stream of an edition, and its damage."""

    edition: str
    stream: str
    listening: Listening
    kind: str
    rate: float

    def line(self, frames: int, seed: int) -> Line:
        """Return the damaged stream."""
        table, count = TABLES[self.edition], int(frames * LENGTHS.get(self.rate, 1.0))
        clean = (
            streams.stream_a(table, count, seed=seed)
            if self.stream == "A"
            else streams.catalogue(table, count, self.listening, seed=seed)
        )
        if self.kind == "line noise":
            return noisy(table, clean, share=self.rate, seed=seed + 1)
        return damage(table, clean, self.kind, self.rate, seed=seed + 1)


def scenarios() -> Iterator[Scenario]:
    """Yield replies with each kind of damage, and a shared line and stream A with all kinds."""
    for edition in TABLES:
        for rate in LENGTHS:
            for kind in KINDS:
                yield Scenario(edition, "catalogue", "reply", kind, rate)
            yield Scenario(edition, "catalogue", "both", "mixed", rate)
            yield Scenario(edition, "A", "reply", "mixed", rate)
        yield Scenario(edition, "catalogue", "reply", "line noise", 0.1)
        yield Scenario(edition, "A", "reply", "line noise", 0.1)


def measure(scenario: Scenario, frames: int, seed: int, reference_bytes: int) -> dict[str, Any]:
    """Measure one row of the report."""
    table = TABLES[scenario.edition]
    line = scenario.line(frames, seed)
    read = {
        "cobotwire": readers.ours(table, "native", scenario.listening)(line.data),
        "any LEN to 64": readers.any_length(64)(line.data),
        "textbook": readers.textbook(table)(line.data),
        "pymycobot": readers.pymycobot()(line.data),
        "pymycobot by request": readers.pymycobot_by_request(line),
    }
    verdicts = {
        name: score(table, scenario.listening, line, frames) for name, frames in read.items()
    }
    return {
        **asdict(scenario),
        "bytes": len(line.data),
        "sent": line.frames,
        "undamaged": int(line.whole.sum()),
        "damages": len(line.sites),
        "ideal": spread(ideal_distances(line)),
        "readers": {name: as_json(verdict) for name, verdict in verdicts.items()},
        "covered": [
            {"frame_at": c.start, "by_false_at": c.false_start, "false": c.false_frame.hex(" ")}
            for c in verdicts["cobotwire"].covered
        ],
        "unexplained": verdicts["cobotwire"].unexplained,
        "late": _late(table, scenario.listening, line.data[:BYTE_BY_BYTE]),
        "codecs_agree": _agree(table, scenario.listening, line.data[:reference_bytes]),
    }


def bounded(edition: str, frames: int, seed: int) -> list[dict[str, Any]]:
    """Measure the effect of the table: scan without it, with any id and any LEN up to a bound."""
    table = TABLES[edition]
    line = Scenario(edition, "A", "reply", "line noise", 0.1).line(frames, 1000 * seed)
    scans: dict[str, Reader] = {"the table": readers.ours(table, "native", "reply")}
    # LEN 254 is FE, a special case: FE FE FE would be a header.
    lengths = {"longest": table.frame.maximum_length, "64": 64, "128": 128, "253": 253, "255": 255}
    for name, longest in lengths.items():
        scans[name] = readers.any_length(longest)
    return [
        {"edition": edition, "bound": name, **as_json(score(table, "reply", line, read(line.data)))}
        for name, read in scans.items()
    ]


def _agree(table: Table, listening: Listening, data: bytes) -> bool:
    native, reference = (
        readers.ours(table, name, listening)(data) for name in ("native", "reference")
    )
    return native == reference


def _late(table: Table, listening: Listening, data: bytes) -> dict[str, int]:
    """Feed byte by byte; count the frames that are delivered after their last byte."""
    framer = codecs.load(table, "native").framer(listening)
    late = []
    for fed, byte in enumerate(memoryview(data).cast("c"), start=1):
        late += [fed - frame.end for frame in readers.accepted(framer.feed(byte))]
    return {"frames": len(late), "late": sum(map(bool, late)), "most": max(late, default=0)}


def main() -> int:
    """Measure and print all rows; return 1 if a lost frame is not explained."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=20_000, help="frames in each row, on average")
    parser.add_argument(
        "--reference-bytes", type=int, default=20_000, help="bytes that both codecs read"
    )
    parser.add_argument("--seed", type=int, default=4)
    parser.add_argument("--show", type=int, default=12, help="how many lost frames to show")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the report to this file")
    options = parser.parse_args()
    started = time.monotonic()
    print(resync_table.HEAD)
    rows = []
    for number, scenario in enumerate(scenarios()):
        seed = 1000 * options.seed + 2 * number
        rows.append(measure(scenario, options.frames, seed, options.reference_bytes))
        print(resync_table.row(rows[-1]), flush=True)
    print(resync_table.summary(rows, options.show))
    bounds = [each for edition in TABLES for each in bounded(edition, options.frames, options.seed)]
    print(resync_table.bounds(bounds))
    print(f"{len(rows)} rows in {time.monotonic() - started:.0f} s")
    if options.json:
        report = {"frames": options.frames, "rows": rows, "bounds": bounds}
        options.json.write_text(json.dumps(report, indent=1))
    return int(any(row["unexplained"] or not row["codecs_agree"] for row in rows))


if __name__ == "__main__":
    sys.exit(main())
