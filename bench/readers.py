"""Who reads the streams: our two codecs, pymycobot's own reader, a textbook state machine.

Each takes the bytes of a line and gives what it took for frames, in order. The peers are given the
best case: they are asked again and again, so that they lose only what their reading itself loses.
"""

from __future__ import annotations

import itertools
import operator
import struct
import warnings
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import NamedTuple
from unittest import mock

from cobotwire import codec as codecs
from cobotwire.codec.interface import Event, Frame, Listening
from cobotwire.table import Table
from streams import Line


class Accepted(NamedTuple):
    """Bytes that a reader took for a frame, and where they stand on the line."""

    start: int
    end: int
    data: bytes


Reader = Callable[[bytes], list[Accepted]]
SECONDS_PER_BYTE = 10 / 115_200


def ours(table: Table, name: codecs.CodecName, listening: Listening) -> Reader:
    """One of our codecs, given the whole line at once."""
    codec = codecs.load(table, name)

    def read(data: bytes) -> list[Accepted]:
        framer = codec.framer(listening)
        return accepted(framer.feed(data) + framer.flush())

    return read


def accepted(events: list[Event]) -> list[Accepted]:
    """The frames among the events."""
    return [
        Accepted(event.offset, event.offset + len(event.data), event.data)
        for event in events
        if isinstance(event, Frame)
    ]


def textbook(table: Table) -> Reader:
    """The policy that consumes on failure, as state machines in textbooks and drivers do.

    pymavlink, for one, moves past all that a header claims before it looks at the checksum. Here:
    header, header, LEN between 2 and the longest, LEN bytes, FA. What does not fit throws away all
    that was taken until then, and the next byte is the first of the next try. Like pymycobot it
    does not look at ids.
    """
    longest = table.frame.maximum_length

    def read(data: bytes) -> list[Accepted]:
        found: list[Accepted] = []
        at = data.find(b"\xfe")
        while 0 <= at < len(data) - 4:
            if data[at + 1] != 0xFE:
                at += 2
            elif not 2 <= data[at + 2] <= longest:
                at += 3
            else:
                start, at = at, at + 3 + data[at + 2]
                if data[at - 1 : at] == b"\xfa":
                    found.append(Accepted(start, at, data[start:at]))
            at = data.find(b"\xfe", at)
        return found

    return read


def any_length(longest: int) -> Reader:
    """Our own scan without the table: any id, any LEN from 2 to ``longest``, FA at the end."""

    def read(data: bytes) -> list[Accepted]:
        found: list[Accepted] = []
        at = data.find(b"\xfe\xfe")
        while 0 <= at < len(data) - 4:
            end = at + 3 + data[at + 2]
            if 2 <= data[at + 2] <= longest and data[end - 1 : end] == b"\xfa":
                found.append(Accepted(at, end, data[at:end]))
                at = data.find(b"\xfe\xfe", end)
            else:
                at = data.find(b"\xfe\xfe", at + 1)
        return found

    return read


def pymycobot() -> Reader:
    """``_read`` of pymycobot's MyCobot280, its own code, called until the line is over.

    This is its best case: nothing that it read is thrown away for being another reply than the one
    waited for. In memory: the port gives one byte a call, as its code asks for; the clock is the
    line's, a byte at 115200 baud for each look at it, so that its 0.5 s are over after 5,760 bytes
    without a frame. A frame counts as read if ``_read`` returns just its bytes when its last byte
    has been taken.
    """
    common, peer = pymycobot_peer()

    def read(data: bytes) -> list[Accepted]:
        line = iter([data[at : at + 1] for at in range(len(data))])
        peer._serial_port = SimpleNamespace(read=partial(next, line, b""))
        clock = SimpleNamespace(time=itertools.count(0.0, SECONDS_PER_BYTE).__next__)
        found: list[Accepted] = []
        with mock.patch.object(common, "time", clock):
            while operator.length_hint(line):
                try:
                    frame = bytes(peer._read(0x20))
                except struct.error:
                    break  # the line ends behind a header: it decodes the LEN that did not come
                if frame:
                    end = len(data) - operator.length_hint(line)
                    found.append(Accepted(end - len(frame), end, frame))
        return found

    return read


def pymycobot_asked(line: Line) -> list[Accepted]:
    """The same code as its users meet it: a request for each frame that was sent, in turn.

    Each request empties the buffer, as ``_res`` does, so that reading starts anew behind the frame
    before; what stands in front of the reply comes behind the request. A frame with another id is
    thrown away, as there. Asking again, which ``_res`` does twice, would be another frame.
    """
    common, peer = pymycobot_peer()
    found: list[Accepted] = []
    begins = [0, *line.ends.tolist()]
    for begin, start, end in zip(begins, line.starts.tolist(), line.ends.tolist()):
        window = iter([line.data[at : at + 1] for at in range(begin, end)])
        # Behind the reply nothing more comes, and its 0.5 s go by.
        times = itertools.chain(itertools.repeat(0.0, end - begin + 1), itertools.repeat(1.0))
        peer._serial_port = SimpleNamespace(read=partial(next, window, b""))
        with mock.patch.object(common, "time", SimpleNamespace(time=times.__next__)):
            frame = bytes(peer._read(0x20))
        if frame[3:4] == line.data[start + 3 : start + 4]:
            stop = end - operator.length_hint(window)
            found.append(Accepted(stop - len(frame), stop, frame))
    return found


def pymycobot_peer() -> tuple[SimpleNamespace, SimpleNamespace]:
    """Pymycobot's module of shared code, and one of its arms without a port."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # importing it calls what Python 3.11 deprecates
        from pymycobot import CommandGenerator, MyCobot280, common
    # As its constructor makes it, but for the port and 1.5 s of sleep.
    peer = object.__new__(MyCobot280)
    CommandGenerator.__init__(peer)
    return common, peer
