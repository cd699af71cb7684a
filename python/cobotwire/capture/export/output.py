"""Write batches to the files of a plan, and publish all files at the end."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Any, Self

from cobotwire.capture.export.atomic_file import AtomicFile, output_error, sync_folder
from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.formats import FORMATS, Format, Sink
from cobotwire.capture.export.inputs import is_url
from cobotwire.capture.export.layout import Layout, empty_table
from cobotwire.capture.export.plan import ExportPlan
from cobotwire.capture.export.report import OutputFile
from cobotwire.protocol.errors import UsageError

# Rows wait in memory until they make a block of this size, so that files are read fast.
BLOCK_ROWS = 1 << 20
BLOCK_BYTES = 64 << 20
# The most bytes of rows that may wait in all files; above it, the largest block is written early.
WAITING_BYTES = 128 << 20
# The most files that are open at the same time; the least recently used one is completed first.
OPEN_FILES = 256


class Target:
    """A file that is being written, and the rows that wait for it."""

    def __init__(self, atomic: AtomicFile, format: Format, schema: Any, plan: ExportPlan) -> None:
        self.atomic, self.schema = atomic, schema
        self.rows = self.waiting_rows = self.waiting_bytes = self.size = 0
        self._waiting: list[Batch] = []
        self._sink: Sink | None = self._guarded(format.open_sink, atomic.file, schema, plan)

    def add(self, batch: Batch) -> None:
        """Add rows; they wait for further ones."""
        self._waiting.append(batch)
        self.rows += batch.table.num_rows
        self.waiting_rows += batch.table.num_rows
        self.waiting_bytes += batch.table.nbytes

    def write_waiting(self) -> None:
        """Write the waiting rows as one block."""
        waiting, self._waiting = self._waiting, []
        self.waiting_rows = self.waiting_bytes = 0
        if waiting:
            assert self._sink is not None, "rows are added to open files only"
            self._guarded(self._sink.write, waiting)

    def complete(self) -> None:
        """Write everything to the disk."""
        if self._sink is not None:
            self.write_waiting()
            sink, self._sink = self._sink, None
            self._guarded(sink.close)
            self.size = self.atomic.finish()

    def discard(self) -> None:
        """Remove the file, unless it is published."""
        self.atomic.discard()
        if self._sink is not None:
            sink, self._sink = self._sink, None
            sink.close()

    def _guarded(self, action: Any, *arguments: Any) -> Any:
        try:
            return action(*arguments)
        except OSError as error:
            raise output_error(self.atomic.path, error) from error


class Output:
    """The files of an export. Leaving it by an exception removes what is not published."""

    def __init__(self, plan: ExportPlan) -> None:
        """Check the format and the output.

        Raises:
            UsageError: the plan cannot be written: see :class:`Layout`; a package is missing.
        """
        if is_url(plan.output):
            message = f"{plan.output} is a URL: only an export with --engine can write there"
            raise UsageError("output", plan.output, message=message)
        self._plan, self._format = plan, FORMATS[plan.format]
        self._format.check_installed()
        self.layout = Layout(plan, self._format)
        # The open files by path, the most recently used last.
        self._targets: dict[Path, Target] = {}
        self._completed: list[Target] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        for target in [*self._completed, *self._targets.values()]:
            target.discard()

    def write(self, batch: Batch) -> None:
        """Add the rows of a batch to their files.

        Raises:
            UsageError: a file exists.
            OutputError: a file cannot be written.
        """
        for path, part in self.layout.split(batch):
            table = self.layout.without_keys(part.table)
            target = self._target(path, table.schema, part.edition)
            target.add(part._replace(table=table))
            if target.waiting_rows >= BLOCK_ROWS or target.waiting_bytes >= BLOCK_BYTES:
                target.write_waiting()
        self._limit_waiting()

    def create_empty(self, schema: Any) -> None:
        """Create the single file of a plan, if no rows have created it."""
        path = Path(self._plan.output)
        self._target(path, empty_table(schema).schema, "")

    def publish(self) -> list[OutputFile]:
        """Complete all files, then give them their final names."""
        targets = [*self._completed, *self._targets.values()]
        for target in targets:
            target.complete()
        for target in targets:
            target.atomic.publish()
        for folder in {target.atomic.path.parent for target in targets}:
            sync_folder(folder)
        return [OutputFile(str(t.atomic.path), t.rows, t.size) for t in targets]

    def _target(self, path: Path, schema: Any, edition: str) -> Target:
        target = self._targets.pop(path, None)
        if target is not None and self._format.per_message and target.schema != schema:
            self._targets[path] = target
            return self._target(self.layout.other(path, edition), schema, edition)
        if target is None:
            target = self._create(path, schema)
        self._targets[path] = target
        return target

    def _create(self, path: Path, schema: Any) -> Target:
        if len(self._targets) >= OPEN_FILES:
            oldest = self._targets.pop(next(iter(self._targets)))
            oldest.complete()
            self._completed.append(oldest)
        taken = {target.atomic.path for target in self._completed}
        name, number = path, 0
        while name in taken:
            number += 1
            name = self.layout.next_part(path, number)
        return Target(AtomicFile(name, self._plan.overwrite), self._format, schema, self._plan)

    def _limit_waiting(self) -> None:
        while sum(target.waiting_bytes for target in self._targets.values()) > WAITING_BYTES:
            max(self._targets.values(), key=lambda target: target.waiting_bytes).write_waiting()
