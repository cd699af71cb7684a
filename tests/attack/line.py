"""The line of a run: a pty or a TCP server, that breaks, stalls and comes back."""

from __future__ import annotations

import os
import select
import socket
import struct
import tempfile
import threading
import time
import tty
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

from attack.arm import HostilePeer, Span
from cobotwire.codec.interface import Codec, Frame

READ_SIZE = 4096
# As long as nothing is due, the loop looks for orders of the run this often.
SLICE_SECONDS = 0.005
SMALL_BUFFER = 1024
# A turn of the loop that takes longer was kept from running.
STALL_SECONDS = 0.02
# More than a pty holds.
LARGE = 1 << 20
# TCP goes on after a stall only when it has probed the peer.
SETTLE_SECONDS = 5.0
NO_LINGER = struct.pack("ii", 1, 0)


class Delivered(NamedTuple):
    """Bytes that were given to the transport.

    Attributes:
        at: when.
        start: their place in all bytes that the arm sent.
        end: the place after them.
    """

    at: float
    start: int
    end: int


class HostileLine:
    """Serves a hostile peer while its ``with`` block runs; ``url`` is what clients open.

    The arm stays the same when the line breaks: a late reply goes to whoever is connected then, and
    its parser keeps half a frame; unless the break takes its power, too (``resets``).

    Attributes:
        frames: the legal requests that arrived before any fault, with their times.
        stalls: when the line itself did not run, and for how many seconds.
        delivered: which of the sent bytes were given to the transport, and when.
    """

    def __init__(self, peer: HostilePeer, codec: Codec, *, tcp: bool, small: bool) -> None:
        self.frames: list[tuple[float, bytes]] = []
        self.delivered: list[Delivered] = []
        self.stalled = False
        self.stalls: list[tuple[float, float]] = []
        self._peer = peer
        self._codec = codec
        self._framer = codec.framer("request")
        self._small = small
        self._unwritten = b""
        self._taken = 0
        self._received = 0
        self._filled = 0
        self._lock = threading.RLock()
        self._over = False
        self._folder = tempfile.TemporaryDirectory(prefix="attack")
        self._listening: socket.socket | None = None
        self._slave = -1
        # Kept open, so that no other run gets a pty of the same name while a client reopens it.
        self._old_slaves: list[int] = []
        self._end: socket.socket | int | None = None
        if tcp:
            self._listening = socket.create_server(("127.0.0.1", 0))
            if small:
                self._listening.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL_BUFFER)
            self._listening.setblocking(False)
            self.url = f"socket://127.0.0.1:{self._listening.getsockname()[1]}"
        else:
            self.url = str(Path(self._folder.name) / "port")
            self._plug()
        self._there = True
        self._thread = threading.Thread(target=self._serve, name="hostile line", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._over = True
        self._thread.join()
        self._drop()
        if self._listening is not None:
            self._listening.close()
        for slave in self._old_slaves:
            os.close(slave)
        self._folder.cleanup()

    def unplug(self, *, resets: bool) -> None:
        """Break the line; :meth:`replug` brings it back."""
        with self._lock:
            self._there = False
            self._drop()
            self._unwritten = b""
            if resets:
                self._framer = self._codec.framer("request")
                self._peer.power_cycle()

    def replug(self) -> None:
        """Bring the line back."""
        with self._lock:
            if self._listening is None:
                self._plug()
            self._there = True

    def fill(self, room: int) -> None:
        """Fill a stalled pty with NULs, but for about ``room`` bytes."""
        with self._lock:
            if self._slave < 0 or not isinstance(self._end, int):
                return
            # The first room that reading makes has another size than that which follows.
            for _ in range(2):
                self._fill_up()
                read = 0
                while not select.select([], [self._slave], [], 0.001)[1]:
                    data = os.read(self._end, 256)
                    self._receive(data)
                    read += len(data)
            self._fill_up(max(0, read - room))

    def _fill_up(self, size: int = LARGE) -> None:
        with suppress(BlockingIOError):
            while size > 0:
                written = os.write(self._slave, bytes(min(size, 1024)))
                self._filled += written
                size -= written

    def settle(self, written: int) -> None:
        """Wait until all bytes have arrived that clients wrote, or until they come no more."""
        self.stalled = False
        until = time.monotonic() + SETTLE_SECONDS
        while self._received < written + self._filled and time.monotonic() < until:
            time.sleep(0.01)

    def _plug(self) -> None:
        master, self._slave = os.openpty()
        tty.setraw(self._slave)
        for descriptor in (master, self._slave):
            os.set_blocking(descriptor, False)
        fresh = self.url + ".new"
        os.symlink(os.ttyname(self._slave), fresh)
        os.replace(fresh, self.url)
        self._end = master

    def _drop(self) -> None:
        if isinstance(self._end, socket.socket):
            with suppress(OSError):
                self._end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NO_LINGER)
            self._end.close()
        elif self._end is not None:
            os.unlink(self.url)
            os.close(self._end)
            self._old_slaves.append(self._slave)
            self._slave = -1
        self._end = None

    def _serve(self) -> None:
        before = time.monotonic()
        while not self._over:
            now = time.monotonic()
            if now - before > STALL_SECONDS:
                self.stalls.append((now, now - before - SLICE_SECONDS))
            before = now
            with self._lock:
                end, wait = self._end, self._peer.wait
                reading = [] if end is None or self.stalled else [end]
                waiting = [] if self._listening is None else [self._listening]
                writing = [end] if end is not None and self._unwritten else []
            timeout = SLICE_SECONDS if wait is None else min(SLICE_SECONDS, wait)
            try:
                ready, _, _ = select.select([*reading, *waiting], writing, [], timeout)
            except (OSError, ValueError):
                continue  # it was unplugged meanwhile
            with self._lock:
                if self._listening in ready:
                    self._accept()
                elif ready and self._end is end:
                    self._read()
                self._write()

    def _accept(self) -> None:
        assert self._listening is not None, "only a TCP line accepts"
        with suppress(OSError):
            accepted, _ = self._listening.accept()
            if not self._there:
                accepted.close()
                return
            self._drop()
            accepted.setblocking(False)
            accepted.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._unwritten = b""
            self._end = accepted

    def _read(self) -> None:
        try:
            if isinstance(self._end, socket.socket):
                data = self._end.recv(READ_SIZE)
            else:
                assert self._end is not None, "it was read from"
                data = os.read(self._end, READ_SIZE)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._drop()
            return
        self._receive(data)

    def _receive(self, data: bytes) -> None:
        now = time.monotonic()
        self._received += len(data)
        self.frames += [
            (now, event.data) for event in self._framer.feed(data) if isinstance(event, Frame)
        ]
        self._take(self._peer.receive(data))

    def _write(self) -> None:
        self._take(self._peer.flush())
        if self._end is None:
            self._unwritten = b""
        if not self._unwritten:
            return
        # Before the client can have them.
        now = time.monotonic()
        try:
            if isinstance(self._end, socket.socket):
                written = self._end.send(self._unwritten)
            else:
                assert self._end is not None, "checked before"
                written = os.write(self._end, self._unwritten)
        except BlockingIOError:
            return
        except OSError:
            self._drop()
            return
        start = self._taken - len(self._unwritten)
        self.delivered.append(Delivered(now, start, start + written))
        self._unwritten = self._unwritten[written:]

    def _take(self, data: bytes) -> None:
        self._taken += len(data)
        self._unwritten += data


def spans_with_places(spans: list[Span]) -> list[tuple[int, Span]]:
    """Return each span with its place in all bytes that the arm sent."""
    placed, place = [], 0
    for span in spans:
        placed.append((place, span))
        place += len(span.data)
    return placed
