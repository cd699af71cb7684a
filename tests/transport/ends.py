"""The far end of a transport, which the test controls: a pty or a TCP connection."""

from __future__ import annotations

import os
import select
import socket
import tty
from contextlib import suppress
from typing import Self

from cobotwire.transport import OpenedTransport, open_transport

FAST = 4_000_000
READ_SIZE = 65_536


class PtyEnd:
    """The master of a pty; ``url`` is the port to open."""

    kind = "serial"

    def __init__(self) -> None:
        self._master, slave = os.openpty()
        tty.setraw(slave)
        self.url = os.ttyname(slave)
        self._slave = slave

    def accept(self) -> None:
        # Now only the transport has the port open, so closing the master unplugs it.
        os.close(self._slave)
        self._slave = -1

    def send(self, data: bytes) -> None:
        assert os.write(self._master, data) == len(data)

    def receive(self, size: int) -> bytes:
        received = b""
        while len(received) < size:
            received += os.read(self._master, size - len(received))
        return received

    def poll(self, seconds: float, size: int = READ_SIZE) -> bytes:
        """Return what comes within some seconds, up to a size."""
        ready = select.select([self._master], [], [], seconds)[0]
        return os.read(self._master, size) if ready else b""

    def drain(self) -> bytes:
        """Wait until nothing more comes; return everything that was written."""
        return b"".join(iter(lambda: self.poll(0.2), b""))

    def unplug(self) -> None:
        for descriptor in (self._master, self._slave):
            if descriptor >= 0:
                os.close(descriptor)
        self._master = self._slave = -1


class TcpEnd:
    """A server that takes one connection at a time."""

    kind = "socket"

    def __init__(self) -> None:
        self._server = socket.create_server(("127.0.0.1", 0))
        self.url = f"socket://127.0.0.1:{self._server.getsockname()[1]}"
        self._peer: socket.socket | None = None

    def accept(self) -> None:
        self._peer, _ = self._server.accept()
        self._peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, data: bytes) -> None:
        assert self._peer is not None
        self._peer.sendall(data)

    def receive(self, size: int) -> bytes:
        assert self._peer is not None
        received = b""
        while len(received) < size:
            received += self._peer.recv(size - len(received))
        return received

    def poll(self, seconds: float) -> bytes:
        """Return what the first client that connects sends within some seconds."""
        with suppress(TimeoutError, ConnectionResetError):
            if self._peer is None:
                self._server.settimeout(seconds)
                self.accept()
            assert self._peer is not None
            if select.select([self._peer], [], [], seconds)[0]:
                return self._peer.recv(READ_SIZE)
        return b""

    def hang_up(self) -> None:
        """Close the connection; the server continues to listen."""
        assert self._peer is not None
        self._peer.close()
        self._peer = None

    def unplug(self) -> None:
        if self._peer is not None:
            self._peer.close()
        self._server.close()


End = PtyEnd | TcpEnd


class Line:
    """A transport and its far end, open during a ``with`` block."""

    def __init__(self, kind: str, baudrate: int = FAST) -> None:
        self.end: End = PtyEnd() if kind == "serial" else TcpEnd()
        self.transport: OpenedTransport = open_transport(self.end.url, baudrate)
        self.end.accept()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.transport.close()
        self.end.unplug()
