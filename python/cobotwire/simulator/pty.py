"""Serve a peer on a pseudo-terminal: a serial port that any program can open."""

from __future__ import annotations

import os
import select
from contextlib import suppress

from cobotwire.protocol.errors import LinkError
from cobotwire.simulator.clock import RunningClock
from cobotwire.simulator.openings import Openings
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.server import READ, Endpoint, Server

try:
    import termios
    import tty
except ModuleNotFoundError:  # Windows
    termios = tty = None  # type: ignore[assignment]

HAS_PTYS = termios is not None


class Pty:
    """A pseudo-terminal in raw mode; ``url`` is the port that programs open.

    Attributes:
        master: the server's end, which never blocks.
        openings: reports when programs open and close the port; None if the system cannot.
    """

    def __init__(self) -> None:
        """Create it.

        Raises:
            LinkError: the system has no pseudo-terminals.
        """
        if not HAS_PTYS:
            raise LinkError("pty", "this system has no pseudo-terminals: serve TCP instead")
        self.master, slave = os.openpty()
        # Raw mode: a terminal would echo the requests and swallow some of their bytes.
        tty.setraw(slave)
        # A client that does not read must not block the server.
        os.set_blocking(self.master, False)
        self.url = os.ttyname(slave)
        self._held: list[int] = [slave]
        self.openings: Openings | None = None
        with suppress(OSError):
            self.openings = Openings(self.url)
            # While this process has the slave open, the system does not report that the last client
            # closed it.
            os.close(self._held.pop())

    @property
    def hung_up(self) -> bool:
        """Whether no program has the port open."""
        poll = select.poll()
        poll.register(self.master, 0)
        return any(event & select.POLLHUP for _, event in poll.poll(0))

    def drop_unread(self) -> None:
        """Drop what the last program did not read."""
        if self.openings is None:
            return
        with self.openings.ignored(), suppress(OSError):
            slave = os.open(self.url, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            termios.tcflush(slave, termios.TCIFLUSH)
            os.close(slave)

    def close(self) -> None:
        """Close it; a program that has it open gets a hangup."""
        for descriptor in (self.master, *self._held):
            os.close(descriptor)
        if self.openings is not None:
            self.openings.close()
            self.openings = None


class PtyServer(Server):
    """Serves a peer on a pty while its ``with`` block runs; ``url`` is the port to open.

    When the last program closes the port, its incomplete request and the replies that it did not
    read are dropped, so that the next program finds neither. Systems other than Linux do not report
    that the port is closed; there the peer gives up the request after a pause.
    """

    def __init__(self, peer: Peer, clock: RunningClock | None = None) -> None:
        """Create the pty; ``clock`` is the one that the peer uses; None: real time.

        Raises:
            LinkError: the system has no pseudo-terminals.
        """
        self._pty = Pty()
        super().__init__(clock)
        self._master, self.url = self._pty.master, self._pty.url
        # Whether a program has the port open; always, if the system does not report it.
        self._opened = self._pty.openings is None
        # Whether a program has closed the port since the last one opened it.
        self._left = False
        self._connect(Endpoint(self._master, self._read, self._write, self._close), peer)
        if self._pty.openings is not None:
            self._selector.register(self._pty.openings.descriptor, READ)
            self._selector.unregister(self._master)

    def _ready(self, descriptor: int, events: int) -> None:
        self._note_openings()
        if descriptor == self._master and self._master in self._clients:
            super()._ready(descriptor, events)

    def _note_openings(self) -> None:
        """Register the port once it is open; if it was closed before, forget the client that left.

        The kernel reports openings before the bytes that follow them.
        """
        for opening in self._pty.openings.read() if self._pty.openings else ():
            if opening and self._left:
                self._forget_client()
            if opening and not self._opened:
                self._register()
            self._left = not opening

    def _register(self) -> None:
        if self._master in self._clients:
            self._opened = True
            self._selector.register(self._master, READ)

    def _read(self, size: int) -> bytes:
        try:
            return os.read(self._master, size)
        except BlockingIOError:
            raise
        except OSError:
            if self._pty.openings is None:
                raise
        # No program has the port open.
        if self._opened:
            self._opened = self._left = False
            self._selector.unregister(self._master)
            self._forget_client()
        raise BlockingIOError

    def _write(self, data: bytes) -> int:
        # What is sent while no program has the port open is lost, as on a serial port.
        return os.write(self._master, data) if self._opened else len(data)

    def _forget_client(self) -> None:
        """Drop the incomplete request of the last client, and the replies that it did not read."""
        if self._pty.openings is None or self._master not in self._clients:
            return
        self._clients[self._master].connection.forget_client()
        self._pty.drop_unread()
        if not self._opened and not self._pty.hung_up:
            self._register()

    def _close(self) -> None:
        openings = self._pty.openings
        if openings is not None and openings.descriptor in self._selector.get_map():
            self._selector.unregister(openings.descriptor)
        self._pty.close()
