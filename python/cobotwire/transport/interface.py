"""What clients need of a transport."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Protocol, runtime_checkable

from cobotwire.protocol.errors import LinkError


@runtime_checkable
class Transport(Protocol):
    """An open port, socket or memory transport that carries bytes."""

    @property
    def url(self) -> str:
        """What was opened, for messages."""
        ...

    def write(self, data: bytes) -> None:
        """Send all of ``data``.

        Raises:
            LinkError: the transport is gone, or does not take the bytes.
        """
        ...

    def read(self, timeout: float) -> bytes:
        """Return the received bytes, as soon as there are any; empty after ``timeout`` seconds.

        Raises:
            LinkError: the transport is gone.
        """
        ...

    def close(self) -> None:
        """Close it. Closing twice is harmless."""
        ...


@runtime_checkable
class PollableTransport(Transport, Protocol):
    """A transport that an event loop can watch; the asyncio client needs no threads for it."""

    def fileno(self) -> int | None:
        """Return the descriptor to watch; None if this transport has no descriptor."""
        ...

    def write_some(self, data: bytes) -> int:
        """Send the bytes that are taken at once; return how many, perhaps 0.

        Raises:
            LinkError: the transport is gone.
        """
        ...


@runtime_checkable
class OpenedTransport(PollableTransport, Protocol):
    """A transport that :func:`cobotwire.transport.open_transport` opened.

    One thread may read while another one writes. ``close`` from a third one ends both at once, with
    a LinkError.
    """

    @property
    def kind(self) -> str:
        """``serial`` for a port, ``socket`` for TCP, else the URL's scheme (``rfc2217``, ``loop``).

        It is for messages, and for checks of a feature that only one kind has, such as a latency
        timer.
        """
        ...

    @property
    def low_latency(self) -> bool:
        """Whether the driver of the port passes short replies on at once.

        By default a USB bridge holds them back for up to 16 ms. For a socket, TCP_NODELAY has this
        effect.
        """
        ...

    def reopen(self) -> None:
        """Close it if it is open, and open the same port again; ``fileno`` may change.

        Bytes underway in either direction are lost. The controller is not reset.

        Raises:
            LinkError: it cannot be opened; it is closed now, and a further attempt may succeed.
        """
        ...


class AsyncTransport(Protocol):
    """A transport on an event loop. Every method is called in the loop's thread; none waits."""

    def read(self) -> bytes:
        """Return the bytes received by now, perhaps none.

        Raises:
            LinkError: the transport is gone.
        """
        ...

    def write(self, data: bytes, done: Callable[[LinkError | None], None]) -> bool:
        """Send ``data`` after what was sent before; return True if all of it was taken at once.

        Otherwise ``done`` is called later: with None when it was taken, or with the error.

        Raises:
            LinkError: the transport is gone.
        """
        ...

    def is_free(self) -> bool:
        """Return whether all written bytes were taken, so that more may be written."""
        ...

    def end_writing(self, most: float = inf) -> None:
        """Stop sending what was not taken yet, where that is possible.

        It is sent nevertheless if more than ``most`` bytes of the first write were taken.
        """
        ...

    def close(self) -> None:
        """Stop watching and close the transport. Closing twice is harmless."""
        ...
