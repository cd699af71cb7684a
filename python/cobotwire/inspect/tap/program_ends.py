"""The end of a tap that the user's program opens: a pty, or a TCP port."""

from __future__ import annotations

import os
import socket

from cobotwire.simulator.pty import Pty
from cobotwire.simulator.tcp import listen, url_of
from cobotwire.transport.descriptor import READ_SIZE


class PtyEnd:
    """A pty: a serial port that any program can open, one after another. No method waits.

    Attributes:
        url: what to open.
        descriptor: readable when the program has sent something; None while no program has it open.
        arrivals: readable when a program opens it; None where the system does not report that.
    """

    def __init__(self) -> None:
        """Create it."""
        self._pty = Pty()
        self.url, openings = self._pty.url, self._pty.openings
        self.arrivals: int | None = openings.descriptor if openings else None
        self.descriptor: int | None = None if openings else self._pty.master
        self._left = False

    def arrive(self) -> tuple[str, bool]:
        """Read the openings of the pty; return what happened, and whether a new program opened it.

        What the last program did not read is dropped.
        """
        new = False
        for opening in self._pty.openings.read() if self._pty.openings else ():
            if opening and self._left and self.descriptor is not None:
                self._pty.drop_unread()
                new = True
            if opening and self.descriptor is None:
                self.descriptor, new = self._pty.master, True
            self._left = not opening
        return "a program opened the port" if new else "", new

    def read(self) -> bytes | None:
        """Return what the program sent; None if nothing yet, empty if the program has left."""
        try:
            return os.read(self._pty.master, READ_SIZE)
        except BlockingIOError:
            return None
        except OSError:
            # No program has it open.
            self.descriptor, self._left = None, False
            self._pty.drop_unread()
            return b""

    def write(self, data: bytes) -> int:
        """Return how many bytes were taken: all, and they are lost, if no program has it open."""
        try:
            return len(data) if self.descriptor is None else os.write(self._pty.master, data)
        except BlockingIOError:
            return 0
        except OSError:
            return len(data)

    def close(self) -> None:
        """Close the pty."""
        self._pty.close()


class TcpEnd:
    """A TCP port, used as :class:`PtyEnd`, for one program; others are disconnected meanwhile."""

    def __init__(self, host: str, port: int) -> None:
        """Listen; raise as :func:`cobotwire.simulator.tcp.listen`."""
        self._listening = listen(host, port)
        self.url = url_of(self._listening)
        self.arrivals: int | None = self._listening.fileno()
        self.descriptor: int | None = None
        self._client: socket.socket | None = None

    def arrive(self) -> tuple[str, bool]:
        """Accept a program."""
        try:
            client, address = self._listening.accept()
        except OSError:
            return "", False
        if self._client is not None:
            client.close()
            return "a second program was disconnected: the port is for one at a time", False
        client.setblocking(False)
        # Otherwise a reply waits until the one before it is acknowledged.
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._client, self.descriptor = client, client.fileno()
        return f"a program connected from {address[0]}", True

    def read(self) -> bytes | None:
        """Return what the program sent; see :meth:`PtyEnd.read`."""
        data = b""
        try:
            data = self._client.recv(READ_SIZE) if self._client else b""
        except BlockingIOError:
            return None
        except OSError:
            pass
        if not data:
            self._leave()
        return data

    def write(self, data: bytes) -> int:
        """Send what the connection takes."""
        try:
            return len(data) if self._client is None else self._client.send(data)
        except BlockingIOError:
            return 0
        except OSError:
            return len(data)

    def _leave(self) -> None:
        if self._client is not None:
            self._client.close()
        self._client = self.descriptor = None

    def close(self) -> None:
        """Disconnect the program, and stop listening."""
        self._leave()
        self._listening.close()


ProgramEnd = PtyEnd | TcpEnd
