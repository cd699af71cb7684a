"""``socket://host:port``: a serial port over TCP, as served by ser2net and by some arms."""

from __future__ import annotations

import socket
from contextlib import suppress

from cobotwire.protocol.errors import LinkError
from cobotwire.transport.descriptor import DescriptorTransport, reason_of

# The limit for each address of the host. It allows for three lost packets in the handshake.
CONNECT_SECONDS = 5.0
# These limits detect a peer that vanished silently, for instance because its Wi-Fi failed: on an
# idle connection by keepalive probes, and while data is sent by missing TCP acknowledgements.
IDLE_SECONDS, PROBE_SECONDS, PROBES = 5, 2, 3
UNACKNOWLEDGED_MS = 10_000


class TcpTransport(DescriptorTransport):
    """An :class:`OpenedTransport` over TCP, which may split frames and join adjacent ones."""

    kind = "socket"
    low_latency = True

    def __init__(self, url: str, baudrate: int, host: str, port: int) -> None:
        """Connect.

        Raises:
            LinkError: no server listens there, or it does not accept within five seconds.
        """
        self._address = (host, port)
        self._socket: socket.socket | None = None
        super().__init__(url, baudrate)

    def _connect(self) -> int:
        try:
            opened = socket.create_connection(self._address, CONNECT_SECONDS)
        # A host name that cannot be encoded raises UnicodeError.
        except (OSError, UnicodeError) as error:
            raise LinkError(self.url, f"cannot be opened: {reason_of(error)}") from error
        opened.setblocking(False)
        # Otherwise a frame waits for the acknowledgement of the one before it.
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        for name, value in (
            ("TCP_KEEPIDLE", IDLE_SECONDS),
            ("TCP_KEEPINTVL", PROBE_SECONDS),
            ("TCP_KEEPCNT", PROBES),
            ("TCP_USER_TIMEOUT", UNACKNOWLEDGED_MS),
        ):
            # Where a platform lacks an option, only missing replies reveal a vanished peer.
            with suppress(AttributeError, OSError):
                opened.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
        self._socket = opened
        return opened.fileno()

    def _release(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _receive(self, size: int) -> bytes:
        return b"" if self._socket is None else self._socket.recv(size)

    def _send(self, data: bytes) -> int:
        return 0 if self._socket is None else self._socket.send(data)

    def _end_of_data(self) -> str:
        return "the peer closed the connection"
