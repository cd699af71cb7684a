"""Compare exports with pyarrow, which writes the same tables when they are ready in memory."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from cobotwire.capture.export import ExportPlan, Inputs, write
from cobotwire.capture.export.formats.parquet_file import settings
from cobotwire.capture.export.output import BLOCK_ROWS
from cobotwire.inspect.exporting import InstalledEditions
from speed_table import Target, Timed


def exports(
    folder: Path, inputs: dict[str, Path], *, wide: bool = False
) -> tuple[dict[str, Timed], Sequence[Target]]:
    """Time the export of captures to Parquet, and pyarrow on the same tables, on one core."""
    timed: dict[str, Timed] = {}
    targets = []
    for number, (name, path) in enumerate(inputs.items()):
        out = folder / f"out {number}"
        plan = ExportPlan(
            str(out), InstalledEditions(), direction="reply", wide=wide, overwrite=True
        )
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
