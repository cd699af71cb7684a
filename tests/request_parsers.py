"""Parsers of requests, as firmware may have them: which frames each finds in a stream of bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.codec.interface import Codec, Frame
from cobotwire.protocol.frame_format import FrameFormat

Parser = Callable[[Codec, bytes], list[bytes]]


def by_the_law(codec: Codec, data: bytes) -> list[bytes]:
    """Parse as our own codec does."""
    framer = codec.framer("request")
    return [event.data for event in framer.feed(data) if isinstance(event, Frame)]


def _check_is_right(format: FrameFormat, frame: bytes) -> bool:
    end = len(frame) - format.check_size
    return end > format.overhead and format.end(frame[:end]) == frame[end:]


def _by_len(format: FrameFormat, data: bytes, cost: Callable[[int], int]) -> Iterator[bytes]:
    """Trust each LEN; discard ``cost(size)`` bytes of a frame with a wrong check."""
    at = 0
    while (at := data.find(format.header, at)) >= 0 and at + format.overhead <= len(data):
        size = format.overhead + data[at + format.length_at]
        if at + size > len(data):
            return
        frame = data[at : at + size]
        if _check_is_right(format, frame):
            yield frame
            at += size
        else:
            at += cost(size)


def by_any_len(codec: Codec, data: bytes) -> list[bytes]:
    """Parse with any LEN; continue after the first header byte of a wrong frame."""
    return list(_by_len(codec.table.frame, data, lambda size: 1))


def by_any_len_skipping(codec: Codec, data: bytes) -> list[bytes]:
    """Parse with any LEN; discard a wrong frame whole, as textbook parsers do."""
    return list(_by_len(codec.table.frame, data, lambda size: size))


PARSERS = (by_the_law, by_any_len, by_any_len_skipping)
