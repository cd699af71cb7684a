"""Export an archive with many workers: one file of each message for each piece.

A task that dies is run again, and one that seems dead may run twice. So each attempt writes into a
hidden folder of its own. When all tasks are complete, the files of the attempts that reported get
their final names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple
from uuid import uuid4

from cobotwire.capture.archive.engine import Engine
from cobotwire.capture.archive.pieces import Piece, divide
from cobotwire.capture.archive.store import Store, store_at
from cobotwire.capture.export.formats import FORMATS
from cobotwire.capture.export.inputs import STDIN, Inputs
from cobotwire.capture.export.layout import Layout
from cobotwire.capture.export.output import Output
from cobotwire.capture.export.plan import ExportPlan
from cobotwire.capture.export.report import Report
from cobotwire.capture.export.sources import Source
from cobotwire.protocol.errors import UsageError

# The name of the file that is in the hidden folder while the export runs.
RUNNING = "running"


class Attempted(NamedTuple):
    """What an attempt wrote: a folder in the store, and a report with paths relative to it."""

    folder: str
    report: Report


class PieceExport(NamedTuple):
    """A task: export one piece into a hidden folder."""

    plan: ExportPlan
    piece: Piece
    folder: str

    def run(self) -> Attempted:
        """Export the piece; return what was read and written."""
        # Another attempt may still be writing.
        folder = f"{self.folder}/{uuid4().hex}"
        report = Report()
        store = store_at(self.plan.output)
        with store.filled(folder) as local:
            plan = replace(self.plan, output=local)
            source = Source(plan, report, lambda size: None)
            with Output(plan) as output:
                for batch in self.piece.batches(plan, source):
                    output.write(batch)
                files = output.publish()
        if not store.has(f"{self.folder}/{RUNNING}"):
            # The export has failed meanwhile, and removed the hidden folder; these files came
            # later.
            store.remove(self.folder)
        report.files = [
            file._replace(path=Path(file.path).relative_to(local).as_posix()) for file in files
        ]
        return Attempted(folder, report)


def export(
    plan: ExportPlan,
    inputs: Inputs,
    engine: Engine,
    piece_bytes: int,
    progress: Callable[[int], None],
) -> Report:
    """Export inputs; :func:`cobotwire.capture.archive.export` describes it."""
    _check(plan, inputs)
    store = store_at(plan.output)
    pieces = divide(inputs, piece_bytes, plan.read_as)
    with _hidden_folder(plan, store) as folder:
        tasks = [
            PieceExport(replace(plan, part=f"{number:05}", overwrite=False), piece, folder)
            for number, piece in enumerate(pieces)
        ]
        attempts: dict[int, Attempted] = {}
        for number, attempted in engine.run(PieceExport.run, tasks):
            attempts[number] = attempted
            progress(pieces[number].bytes)
        ordered = [attempts[number] for number in range(len(tasks))]
        report = Report.merge(attempted.report for attempted in ordered)
        _publish(plan, store, ordered)
    report.files = [
        file._replace(path=f"{plan.output.rstrip('/')}/{file.path}") for file in report.files
    ]
    return report


def _check(plan: ExportPlan, inputs: Inputs) -> None:
    format = FORMATS[plan.format]
    format.check_installed()
    if Layout(plan, format).single:
        message = f"{plan.output} is one file, but each piece needs a file: give a folder"
        raise UsageError("output", plan.output, message=message)
    if any(input.url == STDIN for input in inputs.files):
        message = "- is standard input, which several workers cannot read: store it first"
        raise UsageError("INPUT", STDIN, message=message)


@contextmanager
def _hidden_folder(plan: ExportPlan, store: Store) -> Iterator[str]:
    """Yield the name of a new folder in the store; remove it with its remaining files."""
    found = store.names()
    if found and not plan.overwrite:
        message = (
            f"{plan.output} already holds {found[0]}: old and new rows would mix; give an empty "
            "folder, or --overwrite to replace the files of an earlier export"
        )
        raise UsageError("output", plan.output, message=message)
    folder = f".cobotwire-{uuid4().hex[:12]}"
    store.mark(f"{folder}/{RUNNING}")
    try:
        yield folder
    finally:
        store.remove(folder)


def _publish(plan: ExportPlan, store: Store, attempts: list[Attempted]) -> None:
    """Give the files their final names; with ``overwrite``, remove those of earlier exports."""
    new = {file.path: attempted.folder for attempted in attempts for file in attempted.report.files}
    old = store.names() if plan.overwrite else []
    for name, folder in new.items():
        store.move(f"{folder}/{name}", name)
    format = FORMATS[plan.format]
    messages = [message.label for message in Layout(plan, format).chosen()]
    for name in old:
        file = name.rpartition("/")[2]
        stem = file.removesuffix(format.suffixes[0])
        ours = stem != file and stem.partition("-")[0] in (*messages, "messages")
        if ours and name not in new:
            store.remove(name)
