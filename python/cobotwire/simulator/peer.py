"""The interface of what a server serves: bytes in, bytes out, on the peer's own clock."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

# Peers give up an incomplete request after this pause, so that the next request does not complete
# it.
IDLE_SECONDS = 0.2


class PeerDisconnected(Exception):
    """Raised by a peer that disappears; the server of the peer closes the connection."""


class Peer(Protocol):
    """Something that replies: bytes in, bytes out. It reads its own clock."""

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        ...

    def receive(self, data: bytes) -> bytes:
        """Receive ``data``; return what is to be sent at once."""
        ...

    def flush(self) -> bytes:
        """Return what is to be sent now, without new data."""
        ...


@runtime_checkable
class SharedPeer(Protocol):
    """A peer that serves one client after another: it forgets each when it has left."""

    def forget_client(self) -> None:
        """Forget the incomplete request of the client that has left."""
        ...
