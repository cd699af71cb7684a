"""Turn the chunks of a reader into the blocks of a recording."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from itertools import chain

from cobotwire.capture.damage import MOST_INTERFACES
from cobotwire.capture.foreign.reader import Chunk, ForeignFile, Reader
from cobotwire.capture.packet import Interface, Packet
from cobotwire.capture.packet_parsing import UNDATED, UNTIMED
from cobotwire.capture.writer import CaptureWriter
from cobotwire.protocol.errors import UnreadableInput

LATEST = (1 << 63) - 1
# An earlier time, in nanoseconds since 1970, is not taken as a date.
DATED = 10**18


def recording_of(reader: Reader, file: ForeignFile) -> Iterator[bytes]:
    """Yield the blocks of a pcapng file; each stream of the chunks is an interface.

    If the first chunk has no time, no chunk has one, and the application of the recording ends with
    ``UNTIMED``. If its time is before 2001, the times count from an unknown start, such as a
    trigger. Then the name of the application ends with ``UNDATED``.
    """
    chunks = reader.chunks(file)
    first = next(chunks, None)
    if first is None:
        return
    out = BytesIO()
    mark = UNTIMED if first.time_ns is None else UNDATED if first.time_ns < DATED else ""
    start = min((first.time_ns or 0) // 10**9, 0)
    writer = CaptureWriter(out, reader.name + mark, start)
    interfaces: dict[str, int] = {}
    for chunk in chain([first], chunks):
        if chunk.stream not in interfaces:
            if len(interfaces) == MOST_INTERFACES:
                raise UnreadableInput(file.name, f"holds more than {MOST_INTERFACES} streams")
            interfaces[chunk.stream] = writer.interface(Interface(chunk.stream))
        writer.packet(_packet(file, chunk, start, interfaces[chunk.stream]))
        yield out.getvalue()
        out.seek(0)
        out.truncate()
    writer.finish()
    yield out.getvalue()


def _packet(file: ForeignFile, chunk: Chunk, start: int, interface: int) -> Packet:
    time_ns = chunk.time_ns or 0
    if not start * 10**9 <= time_ns <= LATEST:
        raise UnreadableInput(file.name, f"has a time out of range: {time_ns} ns")
    return Packet(time_ns, chunk.direction, chunk.data, "bytes", interface=interface)
