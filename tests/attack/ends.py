"""The arm's end of a pty or of TCP connections, which breaks and returns under the same URL."""

from __future__ import annotations

import os
import select
import socket
import struct
import tempfile
import tty
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

READ_SIZE = 4096
SMALL_BUFFER = 1024
# More than a pty holds.
LARGE = 1 << 20
NO_LINGER = struct.pack("ii", 1, 0)


class PtyEnd:
    """The master of a pty; the URL is a symbolic link, since each new pty has another name.

    ``read`` and ``write`` raise an OSError if no client is connected.

    Attributes:
        url: what clients open.
        descriptor: the descriptor to read and write; -1: no client is connected.
        waiting: the descriptor that is readable when a client connects; -1: clients need no
            accept().
    """

    waiting = -1

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="attack")
        self.url = str(Path(self._folder.name) / "port")
        self.descriptor = self._slave = -1
        # Kept open, so that no other run gets a pty of the same name while a client reopens it.
        self._old_slaves: list[int] = []
        self.plug()

    def plug(self) -> None:
        """Let clients open the URL."""
        self.descriptor, self._slave = os.openpty()
        tty.setraw(self._slave)
        for descriptor in (self.descriptor, self._slave):
            os.set_blocking(descriptor, False)
        os.symlink(os.ttyname(self._slave), self.url)

    def accept(self, wanted: bool) -> None:
        raise AssertionError("a pty has no connections")

    def read(self) -> bytes:
        return os.read(self.descriptor, READ_SIZE)

    def write(self, data: bytes) -> int:
        return os.write(self.descriptor, data)

    def drop(self) -> None:
        if self.descriptor >= 0:
            os.unlink(self.url)
            os.close(self.descriptor)
            self._old_slaves.append(self._slave)
            self.descriptor = self._slave = -1

    def fill(self, room: int, receive: Callable[[bytes], None]) -> int:
        """Fill the unread line except for ``room`` bytes; return how many bytes that took.

        ``receive`` is called with the bytes that are read meanwhile.
        """
        if self.descriptor < 0:
            return 0
        filled = 0
        # The first read frees another amount of space than later reads.
        for _ in range(2):
            filled += self._fill_up(LARGE)
            read = 0
            while not select.select([], [self._slave], [], 0.001)[1]:
                with suppress(BlockingIOError):
                    data = os.read(self.descriptor, 256)
                    receive(data)
                    read += len(data)
        return filled + self._fill_up(max(0, read - room))

    def _fill_up(self, size: int) -> int:
        filled = 0
        with suppress(BlockingIOError):
            while filled < size:
                filled += os.write(self._slave, bytes(min(size - filled, 1024)))
        return filled

    def close(self) -> None:
        self.drop()
        for slave in self._old_slaves:
            os.close(slave)
        self._folder.cleanup()


class TcpEnd:
    """A server that takes one connection at a time; ``small``: it buffers few bytes."""

    def __init__(self, *, small: bool) -> None:
        self._listening = socket.create_server(("127.0.0.1", 0))
        if small:
            self._listening.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL_BUFFER)
        self._listening.setblocking(False)
        self.waiting = self._listening.fileno()
        self.url = f"socket://127.0.0.1:{self._listening.getsockname()[1]}"
        self._client: socket.socket | None = None
        self.descriptor = -1

    def plug(self) -> None:
        pass

    def accept(self, wanted: bool) -> None:
        with suppress(OSError):
            accepted, _ = self._listening.accept()
            if not wanted:
                accepted.close()
                return
            self.drop()
            accepted.setblocking(False)
            accepted.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._client, self.descriptor = accepted, accepted.fileno()

    def read(self) -> bytes:
        return b"" if self._client is None else self._client.recv(READ_SIZE)

    def write(self, data: bytes) -> int:
        return 0 if self._client is None else self._client.send(data)

    def drop(self) -> None:
        if self._client is not None:
            with suppress(OSError):
                self._client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NO_LINGER)
            self._client.close()
        self._client, self.descriptor = None, -1

    def fill(self, room: int, receive: Callable[[bytes], None]) -> int:
        # A stalled connection needs no filling: its small buffers are full soon.
        return 0

    def close(self) -> None:
        self.drop()
        self._listening.close()


End = PtyEnd | TcpEnd
