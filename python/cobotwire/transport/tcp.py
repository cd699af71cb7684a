"""``socket://host:port``: a serial line behind TCP, as ser2net and the arm's own server give it."""

from __future__ import annotations

import socket
from contextlib import suppress

from cobotwire.errors import LinkError
from cobotwire.transport.descriptor import DescriptorLink, reason_of

# For each address of the host. The three-way handshake takes a round trip; this is three lost ones.
CONNECT_SECONDS = 5.0
# A peer that vanished without a word (its Wi-Fi, say) is given up after about this long, by probes
# while nothing is sent, by missing acknowledgements while something is.
IDLE_SECONDS, PROBE_SECONDS, PROBES = 5, 2, 3
UNACKNOWLEDGED_MS = 10_000


class TcpLink(DescriptorLink):
    """A link over TCP; see :class:`cobotwire.transport.interface.Link`.

    TCP keeps no boundaries: frames come merged and split at will, and so they are read.
    """

    kind = "socket"
    low_latency = True

    def __init__(self, url: str, baudrate: int, host: str, port: int) -> None:
        """Connect.

        Raises:
            LinkError: nobody listens there, or does not answer within five seconds.
        """
        self._address = (host, port)
        self._socket: socket.socket | None = None
        super().__init__(url, baudrate)

    def _connect(self) -> None:
        try:
            opened = socket.create_connection(self._address, CONNECT_SECONDS)
        # A host that cannot be encoded as a name is a UnicodeError.
        except (OSError, UnicodeError) as error:
            raise LinkError(self.url, f"cannot be opened: {reason_of(error)}") from error
        opened.setblocking(False)
        # Or a frame waits for the acknowledgement of the one before it.
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        for name, value in (
            ("TCP_KEEPIDLE", IDLE_SECONDS),
            ("TCP_KEEPINTVL", PROBE_SECONDS),
            ("TCP_KEEPCNT", PROBES),
            ("TCP_USER_TIMEOUT", UNACKNOWLEDGED_MS),
        ):
            # Not every platform has all of these; without them only silence shows it.
            with suppress(AttributeError, OSError):
                opened.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
        self._socket = opened

    def _release(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _descriptor(self) -> int:
        return -1 if self._socket is None else self._socket.fileno()

    def _receive(self, size: int) -> bytes:
        return b"" if self._socket is None else self._socket.recv(size)

    def _send(self, data: bytes) -> int:
        return 0 if self._socket is None else self._socket.send(data)

    def _end_of_data(self) -> str:
        return "the peer closed the connection"
