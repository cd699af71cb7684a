"""What goes over a line, to a capture: cut at frames, every byte kept."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Iterable
from typing import Literal, Protocol

from cobotwire.capture.packet import Interface, Packet, Piece
from cobotwire.capture.writer import CaptureWriter
from cobotwire.codec.interface import Codec, Event, Framer, Noise
from cobotwire.errors import CaptureError

# A frame that stood still this long is written as what has come of it. The longest pause seen
# within a reply is 0.1 s; a cut too early would cost only the picture, never a byte.
IDLE_SECONDS = 0.5

_log = logging.getLogger("cobotwire.capture")


class Moment(Protocol):
    """What a driver's ``trace`` is called with; ``time`` is in ``time.monotonic()`` seconds."""

    @property
    def time(self) -> float:
        """When."""
        ...

    @property
    def direction(self) -> Literal["sent", "heard"]:
        """Which way."""
        ...

    @property
    def data(self) -> bytes:
        """What."""
        ...


class Side:
    """One direction: chunks with their times in, packets out. Every byte is in exactly one."""

    def __init__(self, direction: Literal["sent", "heard"], framer: Framer | None) -> None:
        """Cut by ``framer``; without one, a chunk is a packet of kind ``bytes``."""
        self._direction = direction
        self._framer = framer
        # What came and is in no packet yet, in the pieces in which it came.
        self._waiting: deque[Piece] = deque()
        self._idle_at = 0

    def feed(self, data: bytes, time_ns: int) -> list[Packet]:
        """Take a chunk as it was read or written."""
        if self._framer is None:
            return [Packet(time_ns, self._direction, data, "bytes")] if data else []
        if data:
            self._waiting.append(Piece(len(data), time_ns))
            self._idle_at = time_ns + int(IDLE_SECONDS * 1e9)
        return self._packets(self._framer.feed(data))

    def wake(self, time_ns: int) -> list[Packet]:
        """Let time pass: what has stood still too long waits for its rest no longer."""
        return self.flush() if self._waiting and time_ns >= self._idle_at else []

    def flush(self) -> list[Packet]:
        """Give up what waits for its rest."""
        return [] if self._framer is None else self._packets(self._framer.flush())

    def _packets(self, events: Iterable[Event]) -> list[Packet]:
        """One for each frame; noise between two frames is one, with its first byte's reason."""
        joined: list[Event] = []
        for event in events:
            last = joined[-1] if joined else None
            if isinstance(event, Noise) and isinstance(last, Noise):
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
        """The next ``size`` bytes of what waits; the framer's events come in the line's order."""
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
    """Writes everything that goes over one line to a capture; give it to a driver as ``trace``.

    A recording that fails (a full disk) must not fail the call that moves an arm: it is logged at
    once, recording ends, and :meth:`close` raises.
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
        """Introduce the line to the capture; a writer may have the recorders of several lines.

        Args:
            writer: where packets go.
            codec: by whose edition they are cut; None leaves the chunks as they come.
            url: the port, for who reads the capture.
            baudrate: bits a second, likewise.
            name: the file's, for messages.
        """
        edition = "" if codec is None else codec.table.edition
        self._writer = writer
        self._name = name
        self._index = writer.interface(Interface(url, edition, baudrate))
        self._sent = Side("sent", None if codec is None else codec.framer("request"))
        self._heard = Side("heard", None if codec is None else codec.framer("reply"))
        # Anchored once: a clock that is set meanwhile does not turn the recording's time back.
        self._epoch_ns = time.time_ns() - time.monotonic_ns()
        self._lock = threading.Lock()
        self._failure: OSError | ValueError | None = None

    def __call__(self, moment: Moment) -> None:
        """Record what a driver tells."""
        self.record(moment.direction, moment.data, moment.time)

    def record(self, direction: Literal["sent", "heard"], data: bytes, at: float) -> None:
        """Record a chunk as it was read or written at a ``time.monotonic()`` second."""
        with self._lock:
            time_ns = self._epoch_ns + round(at * 1e9)
            for side in (self._sent, self._heard):
                self._write(side.wake(time_ns))
            side = self._sent if direction == "sent" else self._heard
            self._write(side.feed(data, time_ns))

    def close(self) -> None:
        """Write what waits for its rest. The writer stays open.

        Raises:
            CaptureError: a write has failed, and the recording ends there.
        """
        with self._lock:
            self._write(self._sent.flush())
            self._write(self._heard.flush())
            if self._failure is not None:
                detail = f"recording ended early: {self._failure}"
                raise CaptureError(self._name, self._writer.size, detail) from self._failure

    def _write(self, packets: Iterable[Packet]) -> None:
        for packet in packets:
            if self._failure is not None:
                return
            try:
                self._writer.packet(packet._replace(interface=self._index))
            # A ValueError is what a closed file raises.
            except (OSError, ValueError) as error:
                self._failure = error
                _log.error("recording to %s ended: %s", self._name, error)
