"""Hold the messages of a capture as columns, with times and directions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from cobotwire.capture.captured_rows import CapturedRows, Part, join
from cobotwire.capture.packet import Direction, Interface
from cobotwire.codec.columns import Columns, Rows
from cobotwire.codec.events import Counters
from cobotwire.protocol import table as tables
from cobotwire.protocol.errors import CaptureError, UsageError


class TimedSpans(NamedTuple):
    """The spans of noise in one stream, as one-dimensional memoryviews.

    ``time`` holds the time of the first byte of each span, in nanoseconds since 1970 (UTC);
    ``offset`` its position in the stream; ``size`` its number of bytes.
    """

    time: memoryview
    offset: memoryview
    size: memoryview


class TimedOffsets(NamedTuple):
    """The positions of some bytes in one stream with their times, as memoryviews."""

    time: memoryview
    offset: memoryview


@dataclass(frozen=True)
class StreamColumns:
    """The messages of one direction of one interface, which are one stream of bytes.

    Attributes:
        interface: an index into ``CapturedColumns.interfaces``.
        direction: the direction of the packets.
        columns: rows, rejected frames, noise and counters; the counters cover the stream from its
            start.
        times: for each of the rows in ``columns``, the times of the messages.
        rejected_time: the times of the rejected frames.
        noise_time: the times of the spans of noise.

    Times are memoryviews of 64-bit integers.
    """

    interface: int
    direction: Direction
    columns: Columns
    times: Sequence[memoryview]
    rejected_time: memoryview
    noise_time: memoryview

    @property
    def counters(self) -> Counters:
        """The counts since the start of the stream."""
        return self.columns.counters

    @property
    def noise(self) -> TimedSpans:
        """The spans of noise with their times."""
        return TimedSpans(self.noise_time, *self.columns.noise)

    @property
    def rejected(self) -> TimedOffsets:
        """The legal frames with a value that the edition does not allow, with their times."""
        return TimedOffsets(self.rejected_time, self.columns.rejected)

    def captured(self, rows: Rows) -> CapturedRows:
        """Return rows with their times; rows that are not in ``columns`` must be empty."""
        part = Part(self.interface, self.direction, len(rows))
        for found, time in zip(self.columns, self.times):
            if found is rows:
                return CapturedRows(rows, time, [part])
        return CapturedRows(rows, memoryview(b"").cast("q"), [part])

    def leading(self, rows: Rows) -> dict[str, Any]:
        """Return the columns before the fields in a table of some rows of ``columns``."""
        return self.captured(rows).leading()

    def __iter__(self) -> Iterator[CapturedRows]:
        """Yield the rows of each variant that occurred, in the order of the table."""
        for rows in self.columns:
            yield self.captured(rows)


@dataclass(frozen=True)
class CapturedColumns:
    """The messages of a capture, or of a batch of it.

    Attributes:
        name: the name of the file, for messages.
        application: the name of the program that wrote the capture.
        interfaces: the interfaces that the file describes so far.
        streams: one for each interface and direction that had packets so far, in the order of
            their first packets.
        size: the bytes of the file read so far, after decompression.
        finished: whether the recorder was closed: nothing is missing at the end.
        truncated_at: the offset of the incomplete block at the end of the file; None if the last
            block is complete, or the end has not been read yet.
        error: why the file cannot be read to its end; None if nothing is wrong so far. The columns
            hold everything before that place.
    """

    name: str
    application: str
    interfaces: Sequence[Interface]
    streams: Sequence[StreamColumns]
    size: int
    finished: bool
    truncated_at: int | None
    error: CaptureError | None

    def __iter__(self) -> Iterator[CapturedRows]:
        """Yield the rows of each stream and variant that occurred."""
        for stream in self.streams:
            yield from stream

    def __len__(self) -> int:
        """Return the number of messages."""
        return sum(map(len, self))

    def rows(
        self,
        command: str,
        direction: tables.Direction = "reply",
        variant: int | None = None,
        *,
        interface: int | None = None,
        captured: Direction | None = None,
    ) -> CapturedRows:
        """Return the rows of one message; empty rows if it did not occur.

        The rows of one stream follow those of another, each in the order of its stream.

        Args:
            command: the name of the command.
            direction: whether to return its requests or its replies.
            variant: the index of the variant; required only if several of them occurred.
            interface: restricts the rows to one interface.
            captured: restricts the rows to packets of that direction.

        Raises:
            UsageError: there is no such command, variant or interface; or several variants or
                editions occurred.
        """
        streams = self._chosen(interface, captured)
        found = [
            stream.captured(stream.columns.rows(command, direction, variant)) for stream in streams
        ]
        filled = [rows for rows in found if len(rows)] or found[:1]
        kinds = {(id(rows.command), rows.variant_index) for rows in filled}
        if len(kinds) > 1:
            raise self._several(command, direction, filled)
        return filled[0] if len(filled) == 1 else join(filled)

    def to_arrow(
        self,
        command: str,
        direction: tables.Direction = "reply",
        *,
        wide: bool = False,
        interface: int | None = None,
        captured: Direction | None = None,
    ) -> Any:
        """Return all rows of one message as a ``pyarrow.Table``, in the order of their times.

        The columns are ``time`` (``timestamp[ns]``, UTC), ``direction`` (dictionary),
        ``interface``, ``offset``, ``address`` if frames have an address byte, and those of
        :meth:`cobotwire.codec.columns.Columns.to_arrow`: with ``wide`` each number has its own.
        They do not depend on the rows.

        Args:
            command: the name of the command.
            direction: whether to return its requests or its replies.
            wide: whether each number of a field has a column of its own.
            interface: restricts the rows to one interface.
            captured: restricts the rows to packets of that direction.

        Raises:
            ImportError: pyarrow (the extra ``arrow``) is not installed.
            UsageError: there is no such command or interface, or in several editions that occurred
                the message has other columns.
        """
        from cobotwire.codec.arrow import in_order_of_time

        found = [
            stream.columns.to_arrow(command, direction, wide=wide, leading=stream.leading)
            for stream in self._chosen(interface, captured)
        ]
        if any(table.schema != found[0].schema for table in found):
            message = f"the {command} {direction} has other columns in other editions"
            raise UsageError("interface", None, message=f"{message}: choose one with interface=")
        return in_order_of_time(found)

    def _chosen(self, interface: int | None, captured: Direction | None) -> Sequence[StreamColumns]:
        if interface is not None and not 0 <= interface < len(self.interfaces):
            raise UsageError("interface", interface, f"0..{len(self.interfaces) - 1}")
        streams = [
            stream
            for stream in self.streams
            if interface in (None, stream.interface) and captured in (None, stream.direction)
        ]
        if not streams:
            raise self._no_stream(interface, captured)
        return streams

    def _no_stream(self, interface: int | None, captured: Direction | None) -> UsageError:
        what = "packets" if captured is None else f"packets of direction {captured!r}"
        where = self.name if interface is None else f"interface {interface} of {self.name}"
        return UsageError("capture", self.name, message=f"{where} has no {what}")

    def _several(
        self, command: str, direction: tables.Direction, found: Sequence[CapturedRows]
    ) -> UsageError:
        if len({id(rows.command) for rows in found}) > 1:
            where = sorted({rows.parts[0].interface for rows in found})
            what = " and ".join(map(str, where))
            message = f"interfaces {what} have different editions: choose one with interface="
            return UsageError("interface", None, message=message)
        occurred = " and ".join(str(index) for index in sorted({r.variant_index for r in found}))
        message = f"variants {occurred} of the {command} {direction} occurred"
        return UsageError("variant", None, message=f"{message}: choose one with variant=")
