"""What drivers need of a link."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, runtime_checkable

from cobotwire.errors import LinkError


@runtime_checkable
class Transport(Protocol):
    """An open link."""

    @property
    def url(self) -> str:
        """What was opened, for messages."""
        ...

    def write(self, data: bytes) -> None:
        """Send all of ``data``.

        Raises:
            LinkError: the link is gone, or does not take the bytes.
        """
        ...

    def read(self, timeout: float) -> bytes:
        """What has come, as soon as there is something; empty after ``timeout`` seconds.

        Raises:
            LinkError: the link is gone.
        """
        ...

    def close(self) -> None:
        """Give the link back. Closing twice is harmless."""
        ...


@runtime_checkable
class PollableTransport(Transport, Protocol):
    """A link that an event loop can watch; the asyncio driver needs no threads for it."""

    def fileno(self) -> int | None:
        """The descriptor to watch; None: this one has none after all."""
        ...

    def write_some(self, data: bytes) -> int:
        """Send what is taken at once; gives how many bytes that was, perhaps 0.

        Raises:
            LinkError: the link is gone.
        """
        ...


@runtime_checkable
class Link(PollableTransport, Protocol):
    """A link that :func:`cobotwire.transport.open_link` opened.

    One thread may read while another one writes. ``close`` from a third one ends both at once, with
    a LinkError.
    """

    @property
    def kind(self) -> str:
        """``serial`` for a port, ``socket`` for TCP, else the URL's scheme (``rfc2217``, ``loop``).

        It is there to tell people, and for what only one kind has, such as a latency timer.
        """
        ...

    @property
    def low_latency(self) -> bool:
        """Whether the driver of the port was told not to hold short replies back, and agreed.

        A USB bridge does so for up to 16 ms; TCP_NODELAY is the same thing for a socket.
        """
        ...

    def reopen(self) -> None:
        """Close the link if it is open, and open the same thing again; ``fileno`` may change.

        What was underway in either direction is lost. The controller is not reset.

        Raises:
            LinkError: it cannot be opened; it is closed now, and may be tried again.
        """
        ...


class AsyncLink(Protocol):
    """A link on an event loop. Every method is called in the loop's thread, and none waits."""

    def read(self) -> bytes:
        """What has come by now, perhaps nothing.

        Raises:
            LinkError: the link is gone.
        """
        ...

    def write(self, data: bytes, told: Callable[[LinkError | None], None]) -> bool:
        """Send ``data`` behind what was sent before. True: all of it was taken at once.

        Else ``told`` is called when it was taken, with None; or with the reason why not.

        Raises:
            LinkError: the link is gone.
        """
        ...

    def close(self) -> None:
        """Stop watching and give the link back. Closing twice is harmless."""
        ...
