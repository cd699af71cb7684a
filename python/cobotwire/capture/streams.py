"""Cut the packets of a capture into frames again.

Each direction of each interface is one stream of bytes.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from cobotwire.capture.packet import Direction, Packet
from cobotwire.capture.reader import CaptureReader
from cobotwire.capture.recorder import IDLE_NS
from cobotwire.codec.interface import Codec, Event, Listening
from cobotwire.protocol.errors import EmptyInput, UsageError

LISTENING: dict[Direction, Listening] = {"sent": "request", "received": "reply"}


class DirectionStream:
    """Joins the packets of one direction on one interface, and cuts frames and noise out of them.

    Attributes:
        codec: the codec of the interface's edition.
        interface: an index into ``CaptureReader.interfaces``.
        direction: the direction of the packets.
        listening: what the framer looks for.
        framer: the framer, with its counters.
        start_ns: the time of the first packet.
    """

    def __init__(
        self, codec: Codec, packet: Packet, listening: Listening, accept_unknown: bool
    ) -> None:
        self.codec, self.interface, self.direction = codec, packet.interface, packet.direction
        self.listening = LISTENING.get(packet.direction, listening)
        self.framer = codec.framer(self.listening, accept_unknown=accept_unknown)
        # The start of each piece in the stream, and its time.
        self._times: deque[tuple[int, int]] = deque()
        self._size = 0
        self.start_ns = packet.time_ns
        self._waiting = False

    def is_idle(self, time_ns: int) -> bool:
        """Return whether bytes are pending although none arrived for ``IDLE_NS``."""
        return self._waiting and time_ns >= self._times[-1][1] + IDLE_NS

    def feed(self, packet: Packet) -> list[Event]:
        """Take the next packet of this direction; return the events that are certain by now."""
        for size, time_ns in packet.pieces or ((len(packet.data), packet.time_ns),):
            self._times.append((self._size, time_ns))
            self._size += size
        self._waiting = True
        return self.framer.feed(packet.data)

    def flush(self) -> list[Event]:
        """Stop waiting for more bytes; return the remaining events."""
        self._waiting = False
        return self.framer.flush()

    def time_of(self, offset: int) -> int:
        """Return the time of a byte; the offsets of successive calls must not decrease."""
        while len(self._times) > 1 and self._times[1][0] <= offset:
            self._times.popleft()
        return self._times[0][1]


class StreamEvents(NamedTuple):
    """Events of one stream; ``idle`` means that no later byte can belong to the last of them."""

    stream: DirectionStream
    events: list[Event]
    idle: bool


def cut(
    packets: Iterable[Packet],
    codec_of: Callable[[int], Codec],
    listening: Listening = "both",
    *,
    accept_unknown: bool = False,
) -> Iterator[StreamEvents]:
    """Yield frames and noise of all directions, each as soon as it is certain.

    Args:
        packets: the packets of a capture.
        codec_of: returns the codec of the interface with that index.
        listening: the messages in packets of unknown direction.
        accept_unknown: whether to accept frames with ids that the edition lacks.
    """
    streams: dict[tuple[int, Direction], DirectionStream] = {}
    for packet in packets:
        for stream in streams.values():
            if stream.is_idle(packet.time_ns):
                yield StreamEvents(stream, stream.flush(), idle=True)
        key = packet.interface, packet.direction
        if key not in streams:
            codec = codec_of(packet.interface)
            streams[key] = DirectionStream(codec, packet, listening, accept_unknown)
        yield StreamEvents(streams[key], streams[key].feed(packet), idle=False)
    for stream in streams.values():
        yield StreamEvents(stream, stream.flush(), idle=True)


def packets_of_interface(capture: CaptureReader, interface: int) -> Iterator[Packet]:
    """Yield the packets of one interface.

    Raises:
        EmptyInput: the capture holds no packet.
        UsageError: the capture has no interface with that index.
    """
    yield from (packet for packet in capture if packet.interface == interface)
    if not capture.packets:
        raise EmptyInput(capture.name)
    if not 0 <= interface < len(capture.interfaces):
        raise UsageError("interface", interface, f"0..{len(capture.interfaces) - 1}")
