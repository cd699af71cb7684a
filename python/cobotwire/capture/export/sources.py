"""Turn an input into batches of rows: raw bytes without times, recordings with them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.inputs import Input
from cobotwire.capture.export.opening import InputStream, Progress
from cobotwire.capture.export.plan import ExportPlan, Message
from cobotwire.capture.export.report import Report
from cobotwire.capture.export.tables import MessageTables
from cobotwire.capture.reader import is_capture
from cobotwire.codec.interface import Columns, Counters
from cobotwire.protocol.errors import UsageError

# The bytes to decode at a time. The rows of a piece take some three times as much memory.
PIECE = 16 << 20
# These many bytes tell whether an input is a pcapng file.
MAGIC = 12


class Source:
    """Reads inputs for a plan, and counts what it reads."""

    def __init__(self, plan: ExportPlan, report: Report, progress: Progress) -> None:
        self._plan, self._report, self._progress = plan, report, progress
        self._tables: dict[str, MessageTables] = {}

    def batches(self, input: Input) -> Iterator[Batch]:
        """Yield the chosen rows of an input.

        Raises:
            UsageError: the input cannot be opened, or a time range is given and it has no times.
            LinkError: reading failed.
            CaptureError: a recording is damaged.
        """
        stream = InputStream(input, self._progress)
        try:
            start = stream.read(MAGIC)
            read = self._recording if is_capture(start) else self._raw
            yield from read(input, stream, start)
        finally:
            stream.close()
        self._report.inputs += 1
        if stream.truncated:
            self._report.truncated.append(f"{input.url}: {stream.truncated}")

    def tables(self, edition: str) -> MessageTables:
        """Return the tables of an edition."""
        if edition not in self._tables:
            codec = self._plan.editions.codec(edition)
            self._tables[edition] = MessageTables(codec, self._plan.wide)
        return self._tables[edition]

    def _raw(self, input: Input, stream: InputStream, start: bytes) -> Iterator[Batch]:
        if self._plan.begin_ns is not None or self._plan.end_ns is not None:
            message = f"{input.url} holds raw bytes without times: leave out the time range"
            raise UsageError("INPUT", input.url, message=message)
        reader = self._plan.editions.codec("").column_reader(self._plan.direction)
        piece = start
        while piece:
            yield from self._chosen(reader.feed(piece), input, "")
            piece = stream.read(PIECE)
        columns = reader.flush()
        yield from self._chosen(columns, input, "")
        self._count(columns.counters)

    def _recording(self, input: Input, stream: InputStream, start: bytes) -> Iterator[Batch]:
        message = f"{input.url} is a recording; exporting recordings is not implemented yet"
        raise UsageError("INPUT", input.url, message=message)

    def empty_schema(self, messages: list[Message]) -> Any:
        """Return the schema of the single message of a file without rows."""
        return self.tables("").schema(messages[0])

    def _chosen(self, columns: Columns, input: Input, edition: str) -> Iterator[Batch]:
        self._report.rejected += len(columns.rejected)
        tables = self.tables(edition).tables(columns, input.robot, input.url)
        for message, table in tables:
            if self._plan.chooses(message):
                self._report.rows[message.label] += table.num_rows
                yield Batch(message, edition, input.robot, table)
            else:
                self._report.not_chosen += table.num_rows

    def _count(self, counters: Counters) -> None:
        self._report.bytes += counters.bytes
        self._report.noise.update(counters.noise)
