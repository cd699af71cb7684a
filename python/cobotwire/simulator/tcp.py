"""Serve peers over TCP, as ser2net or the maker's own server do; for several clients."""

from __future__ import annotations

import selectors
import socket
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
        self._listening = _listen(host, port)
        super().__init__(clock)
        self._new_peer = connect
        bound, number = self._listening.getsockname()[:2]
        self.loopback = ip_address(bound).is_loopback
        # A server that listens on all addresses is reached by loopback, too.
        shown = LOOPBACK if ip_address(bound).is_unspecified else bound
        self.url = f"socket://{f'[{shown}]' if ':' in shown else shown}:{number}"
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

    def _accept(self) -> None:
        # A client that disconnects before accept() is not an error.
        with suppress(OSError):
            client, _ = self._listening.accept()
            if self.clients >= MOST_CLIENTS:
                client.close()
                return
            client.setblocking(False)
            # Without this option, a reply waits until the one before it is acknowledged.
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            endpoint = Endpoint(client.fileno(), client.recv, client.send, client.close)
            self._connect(endpoint, self._new_peer())


def address(text: str) -> tuple[str, int]:
    """Return the host and the port of ``HOST:PORT``; without a host, loopback.

    Raises:
        UsageError: the text does not have this form.
    """
    host, colon, number = text.rpartition(":")
    if not colon or not (number.isascii() and number.isdigit()):
        raise UsageError("address", text, "HOST:PORT, or :PORT for this machine alone")
    return host.removeprefix("[").removesuffix("]") or LOOPBACK, int(number)


def _listen(host: str, port: int) -> socket.socket:
    if not 0 <= port <= HIGHEST_PORT:
        raise UsageError("port", port, f"0 (any that is free) ..{HIGHEST_PORT}")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        listening = socket.create_server((host, port), family=family)
    # A host that cannot be encoded as a name is a UnicodeError.
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise LinkError(f"{host}:{port}", f"cannot listen: {reason}") from error
    # A client that connects and disconnects must not block the loop.
    listening.setblocking(False)
    return listening
