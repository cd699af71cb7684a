"""A transport that shows what passes through it, as it passes: recordings use it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from cobotwire.protocol.errors import LinkError
from cobotwire.transport.interface import OpenedTransport, Transport
from cobotwire.transport.timing import times_of

# Called with the direction, the bytes of one read or write, and its time in seconds: that of
# ``time.monotonic()``, or of the transport's own clock.
Tap = Callable[[Literal["sent", "received"], bytes, float], None]


class Tapped:
    """A :class:`~cobotwire.transport.Transport` around another one.

    The tap gets each chunk when it passes. It also gets what a traffic listener never sees: half a
    frame when it arrives, and the written bytes of a write that fails. It runs in the thread that
    reads or writes, and must not raise.
    """

    def __init__(self, transport: Transport, tap: Tap) -> None:
        self._inner, self._tap = transport, tap
        self.url = transport.url
        self._now = times_of(transport).now

    def __repr__(self) -> str:
        return f"<{type(self).__name__} around {self._inner!r}>"

    @property
    def clock(self) -> object:
        """The clock of the inner transport; None: it uses the system's."""
        return getattr(self._inner, "clock", None)

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        try:
            self._inner.write(data)
        except LinkError as error:
            self._show("sent", data[: error.written or 0])
            raise
        self._show("sent", data)

    def read(self, timeout: float) -> bytes:
        """Return the received bytes."""
        data = self._inner.read(timeout)
        self._show("received", data)
        return data

    def close(self) -> None:
        """Close the inner transport. The caller ends the tap."""
        self._inner.close()

    def _show(self, direction: Literal["sent", "received"], data: bytes) -> None:
        if data:
            self._tap(direction, data, self._now())


class TappedTransport(Tapped):
    """An :class:`OpenedTransport` around another one; see :class:`Tapped`."""

    def __init__(self, transport: OpenedTransport, tap: Tap) -> None:
        super().__init__(transport, tap)
        self._transport = transport
        self.kind = transport.kind

    @property
    def low_latency(self) -> bool:
        """Whether the inner transport has low latency."""
        return self._transport.low_latency

    def write_some(self, data: bytes) -> int:
        """Send what is taken at once."""
        taken = self._transport.write_some(data)
        self._show("sent", data[:taken])
        return taken

    def fileno(self) -> int | None:
        """Return the descriptor of the inner transport."""
        return self._transport.fileno()

    def reopen(self) -> None:
        """Close and open the inner transport again; the tap stays."""
        self._transport.reopen()


class _Borrowed(Tapped):
    def close(self) -> None:
        """Leave it open."""


class _BorrowedTransport(TappedTransport):
    def close(self) -> None:
        """Leave it open."""


def borrowed(transport: Transport) -> Transport:
    """Return a transport to the same peer; closing it leaves ``transport`` open.

    A client on it can be closed, and so persist its outstanding replies, before another client uses
    ``transport``.
    """
    if isinstance(transport, OpenedTransport):
        return _BorrowedTransport(transport, _ignore)
    return _Borrowed(transport, _ignore)


def tapped(transport: Transport, tap: Tap) -> Transport:
    """Return a transport to the same peer that shows ``tap`` what passes through it."""
    if isinstance(transport, OpenedTransport):
        return TappedTransport(transport, tap)
    return Tapped(transport, tap)


def _ignore(direction: str, data: bytes, at: float) -> None:
    pass
