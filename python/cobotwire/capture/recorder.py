"""Cut sent and received bytes into the packets of a capture; every byte is kept."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterable
from typing import Literal, Protocol

from cobotwire.capture.packet import Interface, Packet, Piece
from cobotwire.capture.writer import CaptureWriter
from cobotwire.codec.interface import Codec, Event, Framer, Noise
from cobotwire.protocol.errors import CaptureError
from cobotwire.protocol.printable import printable
from cobotwire.transport import forks
from cobotwire.transport.log import Log

# An incomplete frame is written after this pause. The longest pause seen within a reply is 0.1 s;
# a cut that is too early splits a frame into two packets, but loses no byte.
IDLE_NS = 500_000_000

_log = Log("cobotwire.capture")


class TrafficItem(Protocol):
    """One item of a client's traffic; ``time`` is in ``time.monotonic()`` seconds."""

    @property
    def time(self) -> float:
        """The time at which the item was sent or received."""
        ...

    @property
    def direction(self) -> Literal["sent", "received"]:
        """Whether the item was sent or received."""
        ...

    @property
    def data(self) -> bytes:
        """The bytes."""
        ...


class Side:
    """Cuts the chunks of one direction into packets; every byte is in exactly one packet."""

    def __init__(self, direction: Literal["sent", "received"], framer: Framer | None) -> None:
        """Cut with ``framer``; without one each chunk becomes a packet of kind ``bytes``."""
        self._direction = direction
        self._framer = framer
        # The bytes that are in no packet yet, in the pieces in which they arrived.
        self._waiting: deque[Piece] = deque()
        self._idle_at = 0

    def feed(self, data: bytes, time_ns: int) -> list[Packet]:
        """Take a chunk as it was read or written; return the packets that are complete."""
        if self._framer is None:
            return [Packet(time_ns, self._direction, data, "bytes")] if data else []
        if data:
            self._waiting.append(Piece(len(data), time_ns))
            self._idle_at = time_ns + IDLE_NS
        return self._packets(self._framer.feed(data))

    def wake(self, time_ns: int) -> list[Packet]:
        """Return the pending bytes as packets if none arrived for ``IDLE_NS``."""
        return self.flush() if self._waiting and time_ns >= self._idle_at else []

    def flush(self) -> list[Packet]:
        """Return the pending bytes as packets."""
        return [] if self._framer is None else self._packets(self._framer.flush())

    def _packets(self, events: Iterable[Event]) -> list[Packet]:
        """Return a packet for each frame, and one for all noise between two frames."""
        joined: list[Event] = []
        for event in events:
            last = joined[-1] if joined else None
            if isinstance(event, Noise) and isinstance(last, Noise):
                # The reason is that of the first byte.
                joined[-1] = last._replace(data=last.data + event.data)
            else:
                joined.append(event)
        return [self._packet(event) for event in joined]

    def _packet(self, event: Event) -> Packet:
        pieces = self._take(len(event.data))
        start = pieces[0].time_ns
        noise = isinstance(event, Noise)
        return Packet(
            start,
            self._direction,
            event.data,
            "noise" if noise else "frame",
            event.reason if isinstance(event, Noise) else "",
            pieces if len(pieces) > 1 else (),
        )

    def _take(self, size: int) -> tuple[Piece, ...]:
        """Remove the pieces of the next ``size`` bytes; events come in the order of the stream."""
        taken = []
        while size:
            piece = self._waiting.popleft()
            part = min(size, piece.size)
            if part < piece.size:
                self._waiting.appendleft(Piece(piece.size - part, piece.time_ns))
            taken.append(Piece(part, piece.time_ns))
            size -= part
        return tuple(taken)


class Recorder:
    """Writes the traffic of one transport to a capture; pass it to a client as ``trace``.

    If a write fails, for example because the disk is full, the client's call does not fail. Instead
    the error is logged, the recording stops, and :meth:`close` raises an error. In a forked child
    it records nothing, since the capture is the parent's.

    Attributes:
        failure: the error that ended the recording; None if there was none.
    """

    def __init__(
        self,
        writer: CaptureWriter,
        codec: Codec | None,
        *,
        url: str = "",
        baudrate: int = 0,
        name: str = "capture",
    ) -> None:
        """Describe the transport in the capture; several recorders may share a writer.

        Args:
            writer: writes the packets.
            codec: cuts the bytes into frames; None records the chunks as they come.
            url: the port, for the readers of the capture.
            baudrate: bits a second, for the readers of the capture.
            name: the name of the file, for messages.
        """
        edition = "" if codec is None else codec.table.edition
        self._writer = writer
        self._name = name
        self._index = writer.interface(Interface(url, edition, baudrate))
        self._sent = Side("sent", None if codec is None else codec.framer("request"))
        self._received = Side("received", None if codec is None else codec.framer("reply"))
        # Read once, so that setting the clock does not turn the recording's time back.
        self._epoch_ns = time.time_ns() - time.monotonic_ns()
        self._lock = threading.Lock()
        self.failure: OSError | ValueError | None = None
        self._ended = False
        forks.watch(self)

    def __call__(self, item: TrafficItem) -> None:
        """Record one item of a client's traffic."""
        self.record(item.direction, item.data, item.time)

    def record(self, direction: Literal["sent", "received"], data: bytes, at: float) -> None:
        """Record a chunk that was read or written at ``at``, in ``time.monotonic()`` seconds.

        After :meth:`close` this does nothing: another thread may still be finishing a read.
        """
        with self._lock:
            if self._ended:
                return
            time_ns = self._epoch_ns + round(at * 1e9)
            for side in (self._sent, self._received):
                self._write(side.wake(time_ns))
            side = self._sent if direction == "sent" else self._received
            self._write(side.feed(data, time_ns))

    def close(self) -> None:
        """Write the pending bytes. The writer stays open. Closing twice is harmless.

        Raises:
            CaptureError: a write failed, so the recording is incomplete.
        """
        with self._lock:
            if self._ended:
                return
            self._ended = True
            self._write(self._sent.flush())
            self._write(self._received.flush())
            if self.failure is not None:
                detail = f"the recording is incomplete: {self.failure}"
                raise CaptureError(self._name, self._writer.size, detail) from self.failure

    def leave_to_parent(self) -> None:
        """Record nothing from now on; called in a forked child."""
        # Another thread of the parent may have held the lock; it does not exist here.
        self._lock = threading.Lock()
        self._ended = True

    def _write(self, packets: Iterable[Packet]) -> None:
        for packet in packets:
            if self.failure is not None:
                return
            try:
                self._writer.packet(packet._replace(interface=self._index))
            # A closed file raises ValueError.
            except (OSError, ValueError) as error:
                self.failure = error
                _log.load().error("recording to %s stopped: %s", printable(self._name), error)
