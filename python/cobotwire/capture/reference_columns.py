"""Read captures into columns with the Python reader: the specification of the native reader."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence

from cobotwire.capture.block_parsing import Block, Truncated, cut_blocks
from cobotwire.capture.captured_columns import CapturedColumns, StreamColumns
from cobotwire.capture.damage import damaged
from cobotwire.capture.packet import Direction, Interface, Packet
from cobotwire.capture.packet_parsing import PacketParser
from cobotwire.capture.recorder import IDLE_NS
from cobotwire.capture.streams import LISTENING
from cobotwire.codec.columns import Columns, Rows, join_columns, join_rows
from cobotwire.codec.interface import Codec, Data, Listening
from cobotwire.protocol.errors import CaptureError


class ReferenceCaptureReader:
    """Reads a capture piece by piece; see :class:`cobotwire.capture.columns.ColumnsReader`."""

    def __init__(
        self, codec_of: Callable[[Interface], Codec], listening: Listening, raw: bool, name: str
    ) -> None:
        self._codec_of, self._listening, self._raw = codec_of, listening, raw
        self._parser = PacketParser(name)
        self._cut = cut_blocks(name)
        self._bytes = bytearray()
        self._wanted = self._next()
        self._streams: dict[tuple[int, Direction], _Stream] = {}
        self._size = 0
        self._truncated_at: int | None = None
        self._error: CaptureError | None = None
        self._ended = False

    def feed(self, data: Data) -> CapturedColumns:
        """Take the next bytes of the file; return what became certain."""
        self.add(data)
        return self._taken([stream.take() for stream in self._streams.values()])

    def add(self, data: Data) -> None:
        """Take the next bytes of the file; the next call returns what became certain."""
        if self._error is None and not self._ended:
            self._bytes += data
            self._size += memoryview(data).nbytes
            try:
                self._read()
            except CaptureError as error:
                self._error = error

    def finish(self) -> CapturedColumns:
        """Take the end of the file; return the rest."""
        if self._error is None and not self._ended:
            try:
                self._cut.send(bytes(self._bytes))
            except Truncated as end:
                self._truncated_at = end.offset
            except StopIteration:
                pass
        self._ended = True
        for stream in self._streams.values():
            stream.flush()
        return self._taken([stream.take() for stream in self._streams.values()])

    def _next(self) -> int:
        """Take the blocks that are complete; return how many bytes the next one needs."""
        item = next(self._cut)
        while isinstance(item, Block):
            self._take_block(item)
            item = next(self._cut)
        return item

    def _read(self) -> None:
        at = 0
        while len(self._bytes) - at >= self._wanted:
            data = bytes(self._bytes[at : at + self._wanted])
            at += self._wanted
            item = self._cut.send(data)
            if isinstance(item, Block):
                self._take_block(item)
                item = self._next()
            self._wanted = item
        del self._bytes[:at]

    def _take_block(self, block: Block) -> None:
        packet = self._parser.take(block)
        if packet is not None:
            times = (packet.time_ns, *(piece.time_ns for piece in packet.pieces))
            if not -(2**63) <= min(times) <= max(times) < 2**63:
                raise damaged(self._parser.name, block.offset, "time-range")
            self._packet(packet)

    def _packet(self, packet: Packet) -> None:
        for stream in self._streams.values():
            stream.flush_if_idle(packet.time_ns)
        key = packet.interface, packet.direction
        if key not in self._streams:
            codec = self._codec_of(self._parser.interfaces[packet.interface])
            listening = LISTENING.get(packet.direction, self._listening)
            self._streams[key] = _Stream(*key, codec, listening, self._raw)
        self._streams[key].add(packet)

    def _taken(self, streams: Sequence[StreamColumns]) -> CapturedColumns:
        parser = self._parser
        return CapturedColumns(
            parser.name,
            parser.application,
            tuple(parser.interfaces),
            streams,
            self._size,
            parser.finished,
            self._truncated_at,
            self._error,
        )


class _Stream:
    """Joins the packets of one direction on one interface, and decodes them into columns."""

    def __init__(
        self,
        interface: int,
        direction: Direction,
        codec: Codec,
        listening: Listening,
        raw: bool,
    ) -> None:
        self._interface, self._direction = interface, direction
        self._reader = codec.column_reader(listening, raw=raw)
        self._bytes = bytearray()
        self._found: list[Columns] = []
        # The start of each piece in the stream, and its time.
        self._starts: list[int] = []
        self._times: list[int] = []
        self._size = 0
        self._waiting = False

    def flush_if_idle(self, time_ns: int) -> None:
        """Stop waiting for more bytes if none arrived for ``IDLE_NS``."""
        if self._waiting and time_ns >= self._times[-1] + IDLE_NS:
            self.flush()

    def flush(self) -> None:
        """Stop waiting for more bytes."""
        self._decode()
        self._found.append(self._reader.flush())
        self._waiting = False

    def add(self, packet: Packet) -> None:
        """Take the next packet."""
        for size, time_ns in packet.pieces or ((len(packet.data), packet.time_ns),):
            self._starts.append(self._size)
            self._times.append(time_ns)
            self._size += size
        self._bytes += packet.data
        self._waiting = True

    def take(self) -> StreamColumns:
        """Return what became certain since the last call."""
        self._decode()
        found, self._found = self._found, []
        columns = _joined(found)
        noise = self._times_of(columns.noise.offset)
        rejected = self._times_of(columns.rejected)
        times = [self._times_of(rows.offset) for rows in columns]
        return StreamColumns(self._interface, self._direction, columns, times, rejected, noise)

    def _decode(self) -> None:
        self._found.append(self._reader.feed(bytes(self._bytes)))
        self._bytes.clear()

    def _times_of(self, offsets: Iterable[int]) -> memoryview:
        times = [self._times[bisect_right(self._starts, at) - 1] for at in offsets]
        return memoryview(array("q", times))


def _joined(found: Sequence[Columns]) -> Columns:
    """Return the columns of successive parts of one stream."""
    last = found[-1]
    variants: dict[tuple[int, bool, int], list[Rows]] = {}
    for rows in (rows for columns in found for rows in columns):
        index = last.table.commands.index(rows.command)
        key = index, rows.direction == "reply", rows.variant_index
        variants.setdefault(key, []).append(rows)
    offset, size = zip(*[columns.noise for columns in found])
    return Columns(
        last.table,
        [join_rows(variants[key]) for key in sorted(variants)],
        join_columns([columns.rejected for columns in found]),
        (join_columns(offset), join_columns(size)),
        last.counters,
        last.raw,
    )
