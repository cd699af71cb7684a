"""Serve a hostile peer on a pty or over TCP, and break, stall and restore the connection."""

from __future__ import annotations

import select
import threading
import time
from typing import NamedTuple, Self

from attack.arm import HostilePeer
from attack.ends import End
from cobotwire.codec.interface import Codec, Frame

# The longest wait in one turn of the loop, if nothing is due earlier.
SLICE_SECONDS = 0.005
# If a turn takes longer than this, the system did not schedule the thread.
STALL_SECONDS = 0.02
# After a stall, TCP resumes only once it has probed the peer.
SETTLE_SECONDS = 5.0


class Delivered(NamedTuple):
    """Bytes that were given to the transport.

    Attributes:
        at: when.
        start: the offset of the first of them among all bytes that the arm sent.
        end: the offset after the last of them.
    """

    at: float
    start: int
    end: int


class HostileLine:
    """Serves a hostile peer while its ``with`` block runs; ``url`` is what clients open.

    The arm keeps its state when the connection breaks: its parser keeps half a frame, and a late
    reply goes to the client that is connected then. A break with ``resets`` power-cycles the arm.

    Attributes:
        frames: the legal requests that arrived before any fault, with their times.
        stalled: whether the line reads nothing.
        stalls: when the thread of the line was not scheduled, and for how many seconds.
        delivered: which of the sent bytes were given to the transport, and when.
    """

    def __init__(self, peer: HostilePeer, codec: Codec, end: End) -> None:
        self.url = end.url
        self.frames: list[tuple[float, bytes]] = []
        self.delivered: list[Delivered] = []
        self.stalled = False
        self.stalls: list[tuple[float, float]] = []
        self._peer = peer
        self._codec = codec
        self._end = end
        self._framer = codec.framer("request")
        self._unwritten = b""
        self._taken = 0
        self._received = 0
        self._filled = 0
        self._there = True
        self._over = False
        self._lock = threading.RLock()
        self._thread = threading.Thread(target=self._serve, name="hostile line", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._over = True
        self._thread.join()
        self._end.close()

    def unplug(self, *, resets: bool) -> None:
        """Break the line; :meth:`replug` brings it back."""
        with self._lock:
            self._there = False
            self._end.drop()
            self._unwritten = b""
            if resets:
                self._framer = self._codec.framer("request")
                self._peer.power_cycle()

    def replug(self) -> None:
        """Bring the line back."""
        with self._lock:
            self._end.plug()
            self._there = True

    def fill(self, room: int) -> None:
        """Fill a stalled pty with NULs until about ``room`` bytes are free. TCP is not filled."""
        with self._lock:
            self._filled += self._end.fill(room, self._receive)

    def settle(self, written: int) -> None:
        """Wait until all bytes that clients wrote have arrived, for at most ``SETTLE_SECONDS``."""
        self.stalled = False
        until = time.monotonic() + SETTLE_SECONDS
        while self._received < written + self._filled and time.monotonic() < until:
            time.sleep(0.01)

    def _serve(self) -> None:
        before = time.monotonic()
        while not self._over:
            now = time.monotonic()
            if now - before > STALL_SECONDS:
                self.stalls.append((now, now - before - SLICE_SECONDS))
            before = now
            self._turn()

    def _turn(self) -> None:
        end = self._end
        with self._lock:
            descriptor, wait = end.descriptor, self._peer.wait
            reading = [] if descriptor < 0 or self.stalled else [descriptor]
            waiting = [] if end.waiting < 0 else [end.waiting]
            writing = [descriptor] if descriptor >= 0 and self._unwritten else []
        timeout = SLICE_SECONDS if wait is None else min(SLICE_SECONDS, wait)
        try:
            ready, _, _ = select.select([*reading, *waiting], writing, [], timeout)
        except (OSError, ValueError):
            return  # it was unplugged meanwhile
        with self._lock:
            if end.waiting in ready:
                end.accept(wanted=self._there)
                self._unwritten = b""
            elif ready and end.descriptor == descriptor:
                self._read()
            self._write()

    def _read(self) -> None:
        try:
            data = self._end.read()
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if data:
            self._receive(data)
        else:
            self._end.drop()

    def _receive(self, data: bytes) -> None:
        now = time.monotonic()
        self._received += len(data)
        self.frames += [
            (now, event.data) for event in self._framer.feed(data) if isinstance(event, Frame)
        ]
        self._take(self._peer.receive(data))

    def _write(self) -> None:
        self._take(self._peer.flush())
        if self._end.descriptor < 0:
            self._unwritten = b""
        if not self._unwritten:
            return
        # Taken before the write, so the time is not later than the client's receipt.
        now = time.monotonic()
        try:
            written = self._end.write(self._unwritten)
        except BlockingIOError:
            return
        except OSError:
            self._end.drop()
            return
        start = self._taken - len(self._unwritten)
        self.delivered.append(Delivered(now, start, start + written))
        self._unwritten = self._unwritten[written:]

    def _take(self, data: bytes) -> None:
        self._taken += len(data)
        self._unwritten += data
