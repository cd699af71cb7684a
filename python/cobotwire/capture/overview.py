"""Count what a recording holds: times, messages with their rates, gaps and noise."""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from heapq import nlargest
from typing import NamedTuple

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.captured_columns import CapturedColumns
from cobotwire.capture.columns import PIECE, Pieces, capture_reader
from cobotwire.capture.damage import damaged
from cobotwire.capture.gaps import Gaps
from cobotwire.capture.packet import Direction, Interface
from cobotwire.capture.packet_parsing import OURS
from cobotwire.capture.stored_blocks import block_file
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import CaptureError

# The longest gaps are listed; all are counted.
_LISTED = 10
_MAGIC = [re.escape(struct.pack(order + "I", blocks.BYTE_ORDER_MAGIC)) for order in "<>"]
_SECTION = re.compile(b"\n\r\r\n....(?:%s|%s)" % (*_MAGIC,), re.DOTALL)
_SECTION_SIZE = 12


class Gap(NamedTuple):
    """A pause in which no byte came on an interface."""

    length_ns: int
    begin_ns: int
    interface: int


class Times(NamedTuple):
    """How many messages came, and the times of the first and the last one."""

    number: int
    first_ns: int
    last_ns: int

    @property
    def rate(self) -> float | None:
        """Messages per second from the first to the last; None if they have one time."""
        passed = self.last_ns - self.first_ns
        return (self.number - 1) * 1e9 / passed if passed > 0 else None

    def plus(self, other: Times | None) -> Times:
        """Return the sum of both numbers, and the first and the last time of both."""
        if other is None:
            return self
        first, last = min(self.first_ns, other.first_ns), max(self.last_ns, other.last_ns)
        return Times(self.number + other.number, first, last)


class StreamOverview(NamedTuple):
    """One direction of an interface: its bytes, frames, and bytes of noise by reason."""

    interface: int
    direction: Direction
    bytes: int
    frames: int
    noise: dict[str, int]


@dataclass
class Overview:
    """What a recording holds.

    Attributes:
        name: the name of the file.
        size: its bytes after decompression.
        application: the program that wrote it, or its last section.
        format: what a file of another program is, such as ``a socat dump``; empty for pcapng.
        sections: how many sections it has; 0 for a file of another program.
        interfaces: the ports that it describes.
        streams: each direction of each interface.
        messages: the messages by interface and label, such as ``get_angles.reply``.
        rejected: frames with a value that the edition does not allow; they are not among the
            messages.
        times: the range of times of messages, rejected frames and noise; None for an empty
            recording.
        gaps: the longest pauses, longest first.
        gap_count, gap_ns: the number of all pauses, and their sum.
        missing: what the recording lacks at its end; empty if it is whole.
        error: why it cannot be read to its end.
    """

    name: str
    size: int = 0
    application: str = ""
    format: str = ""
    sections: int = 0
    interfaces: tuple[Interface, ...] = ()
    streams: list[StreamOverview] = field(default_factory=list)
    messages: dict[tuple[int, str], Times] = field(default_factory=dict)
    rejected: int = 0
    times: Times | None = None
    gaps: list[Gap] = field(default_factory=list)
    gap_count: int = 0
    gap_ns: int = 0
    missing: str = ""
    error: CaptureError | None = None

    def add(self, batch: CapturedColumns, gaps: dict[int, Gaps], gap_ns: int) -> None:
        """Count a batch of the recording; ``gaps`` has the gaps of each interface."""
        arrived: dict[int, list[int]] = {}
        for stream in batch.streams:
            times = arrived.setdefault(stream.interface, [])
            for rows in stream:
                key = stream.interface, f"{rows.command.name}.{rows.message_direction}"
                found = Times(len(rows), rows.time[0], rows.time[-1])
                self.messages[key] = found.plus(self.messages.get(key))
                times += rows.time
            self.rejected += len(stream.rejected_time)
            times += stream.rejected_time
            times += stream.noise_time
        for interface, times in arrived.items():
            if times:
                self.times = Times(len(times), min(times), max(times)).plus(self.times)
            pauses = gaps.setdefault(interface, Gaps(gap_ns)).take(times)
            found_gaps = [Gap(end - begin, begin, interface) for begin, end in pauses]
            self.gap_count += len(found_gaps)
            self.gap_ns += sum(gap.length_ns for gap in found_gaps)
            self.gaps = nlargest(_LISTED, self.gaps + found_gaps)

    def conclude(self, last: CapturedColumns) -> None:
        """Take what is only known at the end."""
        self.size, self.application = last.size, last.application
        self.interfaces = tuple(last.interfaces)
        for stream in last.streams:
            counts = stream.counters
            noise = {str(reason): size for reason, size in counts.noise.items()}
            where = stream.interface, stream.direction
            frames = sum(counts.frames.values())
            self.streams.append(StreamOverview(*where, counts.bytes, frames, noise))
        self.error = last.error
        if not last.size or last.truncated_at == 0:
            self.error = self.error or damaged(self.name, 0, "not-pcapng")
        if self.error:
            return
        if last.truncated_at is not None:
            self.missing = f"truncated: its last block, at byte {last.truncated_at}, is incomplete"
        # Other programs need not mark a recording as finished.
        elif last.application.startswith(OURS) and not last.finished:
            self.missing = "unfinished: its recorder was killed, or is still recording"


def overview(
    path: str | os.PathLike[str],
    codec_of: Callable[[Interface], Codec],
    gap_ns: int = 1_000_000_000,
    progress: Callable[[int], None] = lambda size: None,
    *,
    piece: int = PIECE,
) -> Overview:
    """Read a recording and count what it holds; damage is part of the result.

    Args:
        path: the file, which may be compressed.
        codec_of: returns the codec of an interface.
        gap_ns: a longer pause counts as a gap.
        progress: gets the size of each read, after decompression.
        piece: how many bytes to read at a time.

    Raises:
        UsageError: the file cannot be opened.
    """
    found = Overview(str(path))
    reader = capture_reader(codec_of, name=found.name)
    gaps: dict[int, Gaps] = {}
    rest, possible_sections = b"", 0
    pieces = Pieces(path, piece)
    for data in pieces:
        progress(pieces.size - found.size)
        found.size = pieces.size
        rest = rest[1 - _SECTION_SIZE :] + data
        possible_sections += len(_SECTION.findall(rest))
        found.add(reader.feed(data), gaps, gap_ns)
    last = pieces.checked(reader.finish())
    found.add(last, gaps, gap_ns)
    found.conclude(last)
    if origin := pieces.origin:
        found.missing = found.missing or "; ".join(f"it {text}" for text in origin.file.missing)
    if origin and origin.reader:
        found.format, found.size = origin.reader.what, pieces.size
    else:
        found.sections = _sections(path) if possible_sections > 1 else possible_sections
    return found


def _sections(path: str | os.PathLike[str]) -> int:
    """Return the number of sections. Block by block, since a packet's bytes may look like one."""
    found = 0
    # The reader of the packets reports the damage.
    with suppress(CaptureError), block_file(path) as file:
        for block in file:
            found += block.kind == blocks.SECTION
    return found
