"""Half a request on the line: what must be sent before the next one.

A write may end after a part of a frame. The peer's parser then waits for the rest, and takes the
next request as that rest: both together can be a legal frame that nobody sent. So fill bytes are
sent first. They end the incomplete frame and make its check wrong, whatever LEN the parser accepts.

Fill bytes cannot help if the part that was written contains a whole legal frame: a parser that
rejects the outer frame finds the inner one. Then the rest of the frame is sent instead, so that the
arm executes what the caller requested, and never something else. A caller who got a LinkError does
not know whether a motion began; ``stop()`` follows in the same write.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import cycle, islice, product
from typing import NamedTuple

from cobotwire.codec.interface import Codec, Frame
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.shared import once_per_table
from cobotwire.protocol.table import Table


class Part(NamedTuple):
    """The first ``written`` bytes of a request, which is all that the peer has of it."""

    request: bytes
    written: int

    @property
    def data(self) -> bytes:
        """The bytes that the peer has."""
        return self.request[: self.written]

    @property
    def rest(self) -> bytes:
        """The bytes that the peer does not have."""
        return self.request[self.written :]


@once_per_table
def _longest(table: Table) -> int:
    """Return the largest LEN of a request."""
    return max(FrameIndex(table, "request").lengths)


class Alignment:
    """Keeps the parts of a request that the peer may hold, and the bytes that end them.

    Attributes:
        align: what must be written before the next request; empty on an aligned line.
        held: every part that the peer may hold: one, or several if it is not known what was
            written; empty on an aligned line.
    """

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._format = codec.table.frame
        self.held: tuple[Part, ...] = ()
        self.align = b""
        # The frame that was sent last; empty if none was since the transport was lost.
        self._last_request = b""

    def sent(self, request: bytes) -> None:
        """Note the frame that is sent now."""
        self._last_request = request

    def end(self) -> None:
        """Note that ``align`` and a request after it were taken whole."""
        if self.align:
            self.hold(())

    def cut(self, align: bytes, request: bytes, written: int | None) -> int | None:
        """Note that only ``written`` bytes of ``align + request`` were taken.

        None: the number is unknown.

        Returns:
            How many of these bytes belong to the request.
        """
        if written is None:
            self.hold(self.held + _all_parts(self._format, request))
            return None
        if written and written >= len(align):
            sent = written - len(align)
            # Text may follow a frame. It is not the beginning of a frame.
            whole = _frame_size(self._format, request)
            self.hold((Part(request, sent),) if 0 < sent < whole else ())
            return sent
        if written and self._completes():
            [part] = self.held
            self.hold((Part(part.request, part.written + written),))
        return 0

    def lose(self) -> None:
        """Note that the transport is gone.

        The last request, and earlier ones that were still on their way, may be cut anywhere.
        """
        last = self._last_request
        if not last:
            return
        longest = _longest(self._codec.table)
        width, order = self._format.length_number
        head = last[: self._format.length_at] + longest.to_bytes(width, order)
        parts = Part(head, len(head)), *_all_parts(self._format, last)
        self.hold(self.held + parts)
        self._last_request = b""

    def hold(self, parts: tuple[Part, ...]) -> None:
        """Note every part that the peer may hold."""
        self.align = self._ending(parts) if parts else b""
        self.held = parts

    def _ending(self, parts: tuple[Part, ...]) -> bytes:
        """Return bytes that end the incomplete request, whichever of the parts the peer holds."""
        fill = fill_bytes(self._format, [part.data for part in parts])
        [first, *others] = parts
        return first.rest if not others and self._exposes(first, fill) else fill

    def _exposes(self, part: Part, fill: bytes) -> bool:
        """Return whether a parser finds another frame once the fill bytes reject this one."""
        framer = self._codec.framer("request")
        events = [*framer.feed(part.data + fill), *framer.flush()]
        return any(isinstance(event, Frame) for event in events)

    def _completes(self) -> bool:
        return len(self.held) == 1 and self.align == self.held[0].rest


def fill_bytes(format: FrameFormat, parts: Sequence[bytes]) -> bytes:
    """Return bytes that end any frame that begins in a part, and complete none of them.

    They do so for every LEN, not only for those of the table: a parser may know other commands, or
    accept any LEN. They repeat a pair of different values that no header or footer has. Two equal
    values could be the command and the check of a frame that ends with a sum.
    """
    reserved = format.header + format.footer
    values = [value for value in range(256) if value not in reserved]
    for pair in product(values, values):
        ends = (end - len(part) for part in parts for _, end in _frames(format, part, pair))
        fill = bytes(islice(cycle(pair), max(1, *ends, 1)))
        if not any(_completes_one(format, part, fill) for part in parts):
            return fill
    raise AssertionError("a frame has one right check, so most pairs do not complete it")


def _frames(format: FrameFormat, part: bytes, pair: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield start and end of each frame that begins in a part, if the pair follows repeatedly."""
    size = len(format.header)
    for start in range(len(part)):
        if format.header.startswith(part[start : start + size]):
            at, width = start + format.length_at, format.length_number.width
            missing = range(len(part), at + width)
            known = part + bytes([pair[(index - len(part)) % 2] for index in missing])
            yield start, start + format.overhead + format.read_length(known, start)


def _completes_one(format: FrameFormat, part: bytes, fill: bytes) -> bool:
    """Return whether fill bytes complete a frame that begins in the part."""
    data = part + fill
    for start, end in _frames(format, part, (fill * 2)[:2]):
        check_at = end - format.check_size
        ends_in_fill = end > len(part) and check_at >= start + format.head_size
        if ends_in_fill and format.end(data[start:check_at]) == data[check_at:end]:
            return True
    return False


def _all_parts(format: FrameFormat, request: bytes) -> tuple[Part, ...]:
    return tuple(Part(request, size) for size in range(1, _frame_size(format, request)))


def _frame_size(format: FrameFormat, request: bytes) -> int:
    """Return the size of the frame at the start of a request."""
    return format.overhead + format.read_length(request)
