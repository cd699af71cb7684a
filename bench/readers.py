"""The readers of the streams: our two codecs, pymycobot's own reader, a textbook state machine.

Each takes the bytes of a line and returns, in order, what it accepts as frames. The peers run under
the best conditions: they are called until the line ends, so that only their reading loses frames.
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
from cobotwire.protocol.table import Table
from streams import Line


class Accepted(NamedTuple):
    """Bytes that a reader accepted as a frame, and their place on the line."""

    start: int
    end: int
    data: bytes


Reader = Callable[[bytes], list[Accepted]]
SECONDS_PER_BYTE = 10 / 115_200


def ours(table: Table, name: codecs.CodecName, listening: Listening) -> Reader:
    """Return one of our codecs as a reader that gets the whole line at once."""
    codec = codecs.load(table, name)

    def read(data: bytes) -> list[Accepted]:
        framer = codec.framer(listening)
        return accepted(framer.feed(data) + framer.flush())

    return read


def accepted(events: list[Event]) -> list[Accepted]:
    """Return the frames among the events."""
    return [
        Accepted(event.offset, event.offset + len(event.data), event.data)
        for event in events
        if isinstance(event, Frame)
    ]


def textbook(table: Table) -> Reader:
    """Return a reader that consumes bytes on failure, as state machines in textbooks do.

    pymavlink, for example, skips the length that a header states before it checks the checksum.
    This reader expects header, header, LEN between 2 and the longest, LEN bytes, FA. If a byte does
    not fit, all bytes so far are lost, and the next byte begins the next attempt. Like pymycobot,
    it ignores ids.
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
    """Return our scan without the table: any id, any LEN from 2 to ``longest``, FA at the end."""

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
    """Return ``_read`` of pymycobot's MyCobot280 as a reader: called until the line ends.

    This is its best case: no reply is dropped because another one is expected. Its port is in
    memory and returns one byte per call, as its code requests. Each call advances its clock by the
    time of one byte at 115200 baud, so its timeout of 0.5 s passes after 5,760 bytes without a
    frame. A frame counts as read if ``_read`` returns it directly after its last byte.
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
                    break  # the line ends after a header: pymycobot decodes a missing LEN
                if frame:
                    end = len(data) - operator.length_hint(line)
                    found.append(Accepted(end - len(frame), end, frame))
        return found

    return read


def pymycobot_by_request(line: Line) -> list[Accepted]:
    """Read with the same code as pymycobot's users: with one request for each frame that was sent.

    Each request empties the buffer, as in ``_res``: reading starts after the previous frame, and
    noise before the reply comes after the request. A frame with another id is dropped, as in
    ``_res``. There is no second attempt: its reply would be another frame.
    """
    common, peer = pymycobot_peer()
    found: list[Accepted] = []
    begins = [0, *line.ends.tolist()]
    for begin, start, end in zip(begins, line.starts.tolist(), line.ends.tolist()):
        window = iter([line.data[at : at + 1] for at in range(begin, end)])
        # Nothing follows the reply, so pymycobot's timeout of 0.5 s passes.
        times = itertools.chain(itertools.repeat(0.0, end - begin + 1), itertools.repeat(1.0))
        peer._serial_port = SimpleNamespace(read=partial(next, window, b""))
        with mock.patch.object(common, "time", SimpleNamespace(time=times.__next__)):
            frame = bytes(peer._read(0x20))
        if frame[3:4] == line.data[start + 3 : start + 4]:
            stop = end - operator.length_hint(window)
            found.append(Accepted(stop - len(frame), stop, frame))
    return found


def pymycobot_peer() -> tuple[SimpleNamespace, SimpleNamespace]:
    """Return pymycobot's module of shared code, and one of its arms without a port."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its import uses features that Python 3.11 deprecates
        from pymycobot import CommandGenerator, MyCobot280, common
    # This does what its constructor does, but opens no port and does not sleep for 1.5 s.
    peer = object.__new__(MyCobot280)
    CommandGenerator.__init__(peer)
    return common, peer
