"""Turn an input into batches of rows: raw bytes without times, recordings with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from cobotwire.capture.captured_columns import CapturedColumns
from cobotwire.capture.columns import capture_reader
from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.inputs import Input
from cobotwire.capture.export.opening import InputStream, Progress
from cobotwire.capture.export.plan import ExportPlan, Message
from cobotwire.capture.export.report import Report
from cobotwire.capture.export.tables import MessageTables, Origin, occurring
from cobotwire.capture.foreign.recognising import ExportedInput
from cobotwire.capture.gaps import Gaps
from cobotwire.capture.packet import Interface
from cobotwire.capture.packet_parsing import OURS, UNDATED, UNTIMED
from cobotwire.codec.interface import Codec, Columns, Counters, Listening
from cobotwire.protocol.errors import EmptyInput, UnreadableInput, UsageError

# The bytes to decode at a time. The rows of a piece take some three times as much memory.
PIECE = 8 << 20


class Source:
    """Reads inputs for a plan, and counts what it reads."""

    def __init__(self, plan: ExportPlan, report: Report, progress: Progress) -> None:
        self._plan, self._report, self._progress = plan, report, progress
        self._tables: dict[str, MessageTables] = {}

    def batches(self, input: Input) -> Iterator[Batch]:
        """Yield the chosen rows of an input; leave out what follows damage in a recording.

        An input that is empty, or in no known format, has no rows; the report names it.

        Raises:
            UsageError: the input cannot be opened, or the plan needs times and it has none.
            LinkError: reading failed.
        """
        try:
            yield from self._batches(input)
        except ExportedInput as error:
            # Folders often hold the files of earlier exports too.
            if input.listed:
                self._report.notes.append(f"left out: {error}")
            else:
                self._unread(error)
        except UnreadableInput as error:
            self._unread(error)

    def _unread(self, error: UnreadableInput) -> None:
        self._report.unread.append(str(error))
        self._report.inputs += 1

    def _batches(self, input: Input) -> Iterator[Batch]:
        stream = InputStream(input, self._progress, self._plan.read_as or None, self._plan.ports)
        found = stream.found
        if found.notice and not self._plan.read_as:
            self._report.notes.append(found.notice)
        try:
            read = self._recording if found.recording else self._raw
            yield from read(input, stream)
        finally:
            stream.close()
        self._report.notes.extend(found.file.notes)
        for missing in (*found.file.missing, stream.truncated):
            if missing:
                self._report.truncated.append(f"{input.url}: {missing}")

    def empty_schema(self, message: Message) -> Any:
        """Return the schema of a file without rows."""
        return self._tables_of(self._plan.editions.codec("")).schema(message)

    def decoded(
        self, input: Input, parts: Iterable[Columns], first: bool = True
    ) -> Iterator[Batch]:
        """Yield the chosen rows of raw bytes that were decoded elsewhere, in one or more parts.

        Only the counters of the last part are added, because they cover all parts. ``first`` is
        whether the first part is the start of the input: a divided input counts once.

        Raises:
            UsageError: the plan needs times, which raw bytes do not have.
        """
        self._check_times(input)
        origin = Origin(input.robot, input.url)
        counters = Counters(0, {}, {}, 0)
        for columns in parts:
            yield from self._chosen(columns, origin)
            counters = columns.counters
        self._count(counters)
        self._report.inputs += first

    def _raw(self, input: Input, stream: InputStream) -> Iterator[Batch]:
        codec = self._plan.editions.codec("")
        return self.decoded(input, _parts(codec, self._plan.direction, stream))

    def _recording(self, input: Input, stream: InputStream) -> Iterator[Batch]:
        reader = capture_reader(self._codec_of, self._plan.direction, name=input.url)
        gaps: dict[int, Gaps] = {}
        while piece := stream.read(PIECE):
            yield from self._captured(reader.feed(piece), input, gaps)
        last = reader.finish()
        yield from self._captured(last, input, gaps)
        if not (last.streams or last.error or last.truncated_at):
            raise EmptyInput(input.url)
        if last.application.endswith(UNDATED):
            message = "its times have no date; the column time counts them from 1970-01-01"
            self._report.notes.append(f"{input.url}: {message}")
        self._report.inputs += 1
        for part in last.streams:
            self._count(part.counters)
        if incomplete := _incomplete(last):
            self._report.truncated.append(f"{input.url}: {incomplete}")

    def _check_times(self, input: Input) -> None:
        if self._plan.needs_times:
            what = "an MCAP file" if self._plan.format == "mcap" else "a time range"
            message = f"{input.url} holds bytes without times, which {what} needs"
            raise UsageError("INPUT", input.url, message=message)

    def _codec_of(self, interface: Interface) -> Codec:
        return self._plan.editions.codec(interface.edition)

    def _captured(
        self, batch: CapturedColumns, input: Input, gaps: dict[int, Gaps]
    ) -> Iterator[Batch]:
        for interface in dict.fromkeys(stream.interface for stream in batch.streams):
            streams = [stream for stream in batch.streams if stream.interface == interface]
            robot = f"{input.robot}-{interface}" if interface else input.robot
            found = gaps.setdefault(interface, Gaps(self._plan.gap_ns))
            timed = not batch.application.endswith(UNTIMED)
            times = [time for stream in streams for times in stream.times for time in times]
            if self._plan.format == "mcap" and min(times, default=0) < 0:
                message = f"{input.url} has times before 1970, which an MCAP file cannot hold"
                raise UsageError("INPUT", input.url, message=message)
            if not timed:
                self._check_times(input)
            elif count := sum(1 for _ in found.take(times)):
                self._report.gaps[robot] += count
            for stream in streams:
                origin = Origin(robot, input.url, stream if timed else None)
                yield from self._chosen(stream.columns, origin)

    def _chosen(self, columns: Columns, origin: Origin) -> Iterator[Batch]:
        self._report.rejected += len(columns.rejected)
        edition = columns.table.edition
        tables = self._tables_of(columns)
        for message, count in occurring(columns).items():
            if not self._plan.chooses(message):
                self._report.not_chosen += count
                continue
            table = tables.table(columns, message, origin)
            inside = self._inside(table)
            self._report.outside += table.num_rows - inside.num_rows
            if inside.num_rows:
                self._report.rows[message.label] += inside.num_rows
                yield Batch(message, edition, origin.robot, inside)

    def _inside(self, table: Any) -> Any:
        """Return the rows in the plan's time range."""
        for end, compare in (
            (self._plan.begin_ns, pc.greater_equal),
            (self._plan.end_ns, pc.less),
        ):
            if end is not None:
                time = table.column("time")
                table = table.filter(compare(time, pa.scalar(end, pa.int64()).cast(time.type)))
        return table

    def _tables_of(self, decoded: Columns | Codec) -> MessageTables:
        edition = decoded.table.edition
        if edition not in self._tables:
            wide = self._plan.wide or self._plan.format == "csv"
            self._tables[edition] = MessageTables(decoded.table, wide)
        return self._tables[edition]

    def _count(self, counters: Counters) -> None:
        self._report.bytes += counters.bytes
        self._report.noise.update(counters.noise)


def _parts(codec: Codec, listening: Listening, stream: InputStream) -> Iterator[Columns]:
    """Yield the columns of raw bytes."""
    reader = codec.column_reader(listening)
    while piece := stream.read(PIECE):
        yield reader.feed(piece)
    yield reader.flush()


def _incomplete(capture: CapturedColumns) -> str:
    """Return what is missing at the end of a recording; empty if nothing is."""
    if capture.error is not None:
        return f"{capture.error}; everything before that is exported"
    if capture.truncated_at is not None:
        return f"it ends in the middle of a packet, after byte {capture.truncated_at}"
    # Other programs need not write the statistics that mark a recording as finished.
    unfinished = capture.application.startswith(OURS) and not capture.finished
    return "the recording was not finished" if unfinished else ""
