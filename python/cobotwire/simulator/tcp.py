"""Serve peers over TCP, as ser2net or the maker's own server do; for several clients."""

from __future__ import annotations

import selectors
import socket
import time
from collections.abc import Callable
from contextlib import suppress
from ipaddress import ip_address

from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.simulator.clock import RunningClock
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.server import Endpoint, Server

LOOPBACK = "127.0.0.1"
ANY_FREE_PORT = 0
HIGHEST_PORT = 65535
# Further clients are disconnected: a runaway program must not use up all descriptors.
MOST_CLIENTS = 64
# A client that has been silent for this long is disconnected to make room for a new one.
IDLE_SECONDS = 2.0
# While the system has no descriptor left, the server tries to accept a client at most this often.
RETRY_SECONDS = 0.2
# A client is accepted only if this many descriptors are free.
SPARE_DESCRIPTORS = 4


class TcpServer(Server):
    """Serves clients over TCP while its ``with`` block runs; ``url`` is what they open.

    Each client has its own connection: bytes of two clients never mix, and each gets only the
    replies to its own requests. A real serial line that ser2net serves is shared by all clients;
    fault scenarios show how that damages replies.
    """

    def __init__(
        self,
        connect: Callable[[], Peer],
        host: str = LOOPBACK,
        port: int = ANY_FREE_PORT,
        clock: RunningClock | None = None,
    ) -> None:
        """Listen.

        Args:
            connect: makes the peer of each client: ``arm.connect``, for one arm that all share.
            host: the address to listen on. Connections are not authenticated: every program that
                reaches the address can move the arm.
            port: the TCP port; 0: any free port.
            clock: the one that the peers use; None: real time.

        Raises:
            UsageError: there is no such port number.
            LinkError: it is not possible to listen on the address.
        """
        self._listening = listen(host, port)
        super().__init__(clock)
        self._new_peer = connect
        self.url = url_of(self._listening)
        self.loopback = ip_address(self._listening.getsockname()[0]).is_loopback
        # The time since which no client is accepted; None: clients are accepted.
        self._paused_at: float | None = None
        self._selector.register(self._listening, selectors.EVENT_READ)

    @property
    def clients(self) -> int:
        """The number of connected clients."""
        return len(self._clients)

    def close(self) -> None:
        """Stop listening, and disconnect all clients."""
        super().close()
        self._listening.close()

    def _ready(self, descriptor: int, events: int) -> None:
        if descriptor == self._listening.fileno():
            self._accept()
        else:
            super()._ready(descriptor, events)

    def _wait(self, call_at: float | None) -> float | None:
        wait = super()._wait(call_at)
        if self._paused_at is None:
            return wait
        left = self._paused_at + RETRY_SECONDS - time.monotonic()
        if left <= 0:
            self._paused_at = None
            self._selector.register(self._listening, selectors.EVENT_READ)
            return wait
        return left if wait is None else min(left, wait)

    def _accept(self) -> None:
        if not self._descriptors_are_free():
            if not self._drop_idle_client():
                # The client still waits: select() would return at once, again and again.
                self._selector.unregister(self._listening)
                self._paused_at = time.monotonic()
            return
        # A client that disconnects before accept() is not an error.
        with suppress(OSError):
            client, _ = self._listening.accept()
            if self.clients >= MOST_CLIENTS and not self._drop_idle_client():
                client.close()
                return
            client.setblocking(False)
            # Without this option, a reply waits until the one before it is acknowledged.
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            endpoint = Endpoint(client.fileno(), client.recv, client.send, client.close)
            self._connect(endpoint, self._new_peer())

    def _descriptors_are_free(self) -> bool:
        """Return whether descriptors are left for a client and for the imports of a reply."""
        free: list[socket.socket] = []
        try:
            with suppress(OSError):
                free += (self._listening.dup() for _ in range(SPARE_DESCRIPTORS))
        finally:
            for copy in free:
                copy.close()
        return len(free) == SPARE_DESCRIPTORS

    def _drop_idle_client(self) -> bool:
        """Disconnect the client that has been silent for longest, if that is long enough.

        A client that has never sent a byte is disconnected first.
        """
        latest = time.monotonic() - IDLE_SECONDS
        idle = [client for client in self._clients.values() if client.active_at < latest]
        if not idle:
            return False
        self._drop(min(idle, key=lambda client: (client.has_sent, client.active_at)))
        return True


def address(text: str) -> tuple[str, int]:
    """Return the host and the port of ``HOST:PORT``; without a host, loopback.

    Raises:
        UsageError: the text does not have this form.
    """
    host, colon, number = text.rpartition(":")
    if not colon or not (number.isascii() and number.isdigit() and len(number) <= 5):
        raise UsageError("address", text, "HOST:PORT, or :PORT for this machine alone")
    return host.removeprefix("[").removesuffix("]") or LOOPBACK, int(number)


def url_of(listening: socket.socket) -> str:
    """Return what a program on this machine opens to reach a socket that listens."""
    bound, number = listening.getsockname()[:2]
    # A server that listens on all addresses is reached by loopback, too.
    shown = LOOPBACK if ip_address(bound).is_unspecified else bound
    return f"socket://{f'[{shown}]' if ':' in shown else shown}:{number}"


def listen(host: str, port: int) -> socket.socket:
    """Listen; raise as :class:`TcpServer`."""
    if not 0 <= port <= HIGHEST_PORT:
        raise UsageError("port", port, f"0 (any that is free) ..{HIGHEST_PORT}")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        listening = socket.create_server((host, port), family=family)
    # A host name that cannot be encoded raises UnicodeError.
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise LinkError(f"{host}:{port}", f"cannot listen: {reason}") from error
    # A client that connects and disconnects must not block the loop.
    listening.setblocking(False)
    return listening
