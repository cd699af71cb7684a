"""``socket://host:port``: a serial line over TCP, as ser2net and the arm's own server offer it."""

from __future__ import annotations

import socket
from contextlib import suppress

from cobotwire.protocol.errors import LinkError
from cobotwire.transport.descriptor import DescriptorTransport, reason_of

# For each address of the host. A handshake takes one round trip; this is enough for three losses.
CONNECT_SECONDS = 5.0
# A peer that vanished silently (with its Wi-Fi, say) is given up after about this long: by probes
# while nothing is sent, by missing acknowledgements while something is.
IDLE_SECONDS, PROBE_SECONDS, PROBES = 5, 2, 3
UNACKNOWLEDGED_MS = 10_000


class TcpTransport(DescriptorTransport):
    """An :class:`OpenedTransport` over TCP, which merges and splits frames at will."""

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
        # A host that cannot be encoded as a name is a UnicodeError.
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
            # Some platforms lack some of these; there only silence shows that the peer is gone.
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
