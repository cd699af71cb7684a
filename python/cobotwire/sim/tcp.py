"""A simulated arm over TCP, as ser2net or the maker's own server give one; for several clients."""

from __future__ import annotations

import selectors
import socket
from collections.abc import Callable
from contextlib import suppress
from ipaddress import ip_address

from cobotwire.errors import LinkError, UsageError
from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.channel import End
from cobotwire.sim.clock import RunningClock
from cobotwire.sim.peer import Peer
from cobotwire.sim.server import Server

LOOPBACK = "127.0.0.1"
ANY_FREE_PORT = 0
HIGHEST_PORT = 65535
# Whoever comes when so many are there is sent away; a runaway client must not take all descriptors.
MOST_CLIENTS = 64


class TcpPort(Server):
    """Serves clients over TCP while its ``with`` block runs; ``url`` is what they open.

    Each client has a line of its own: the bytes of two never mix, and each is told the answers to
    its own requests alone. A real serial line behind ser2net has one line for all; what that does
    to replies is a fault, and no way to serve.
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
            connect: makes the peer for each client that comes.
            host: the address to listen on. Whoever can reach it moves the arm: nobody is asked who
                he is.
            port: 0 takes one that is free.
            clock: by which the peers count how long they wait; left out: real time.

        Raises:
            UsageError: the port is none.
            LinkError: the address cannot be listened on.
        """
        self._listening = _listen(host, port)
        super().__init__(clock)
        self._new_peer = connect
        bound, number = self._listening.getsockname()[:2]
        self.loopback = ip_address(bound).is_loopback
        # Who listens everywhere is found here, too.
        shown = LOOPBACK if ip_address(bound).is_unspecified else bound
        self.url = f"socket://{f'[{shown}]' if ':' in shown else shown}:{number}"
        self._selector.register(self._listening, selectors.EVENT_READ)

    @property
    def clients(self) -> int:
        """How many are connected."""
        return len(self._channels)

    def close(self) -> None:
        """Listen no more, and hang up on everybody."""
        super().close()
        self._listening.close()

    def _ready(self, descriptor: int, events: int) -> None:
        if descriptor == self._listening.fileno():
            self._accept()
        else:
            self._hear(descriptor, events)

    def _accept(self) -> None:
        # Whoever has gone again before he was let in is no failure.
        with suppress(OSError):
            client, _ = self._listening.accept()
            if self.clients >= MOST_CLIENTS:
                client.close()
                return
            client.setblocking(False)
            # Or an answer waits for the acknowledgement of the one before it.
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            end = End(client.fileno(), client.recv, client.send, client.close)
            self._connect(end, self._new_peer())


class TcpServer(TcpPort):
    """Serves one simulated arm to all who come: what one of them sets, the others see."""

    def __init__(
        self,
        arm: SimulatedArm,
        host: str = LOOPBACK,
        port: int = ANY_FREE_PORT,
        clock: RunningClock | None = None,
    ) -> None:
        super().__init__(arm.another_line, host, port, clock)
        self.arm = arm


def address(text: str) -> tuple[str, int]:
    """``HOST:PORT`` in its parts; without a host it is this machine alone.

    Raises:
        UsageError: it is none.
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
        raise LinkError(f"{host}:{port}", f"cannot be listened on: {reason}") from error
    # Somebody who knocks and goes must not hold the loop up.
    listening.setblocking(False)
    return listening
