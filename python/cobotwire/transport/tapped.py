"""A transport that shows what passes through it, as it passes: recordings use it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from cobotwire.protocol.errors import LinkError
from cobotwire.transport.interface import OpenedTransport
from cobotwire.transport.timing import times_of

# Called with the direction, the bytes of one read or write, and its time in seconds: that of
# ``time.monotonic()``, or of the transport's own clock.
Tap = Callable[[Literal["sent", "received"], bytes, float], None]


class TappedTransport:
    """An :class:`OpenedTransport` around another one.

    The tap gets each chunk at its own time, which no traffic listener can see: half a frame when it
    comes, and of a write that fails the bytes that were taken. It runs in the thread that reads or
    writes, and must not raise.
    """

    def __init__(self, transport: OpenedTransport, tap: Tap) -> None:
        self._transport, self._tap = transport, tap
        self.url, self.kind = transport.url, transport.kind
        self._now = times_of(transport).now

    def __repr__(self) -> str:
        return f"<{type(self).__name__} around {self._transport!r}>"

    @property
    def clock(self) -> object:
        """The clock of the inner transport; None: it goes by the system's."""
        return getattr(self._transport, "clock", None)

    @property
    def low_latency(self) -> bool:
        """Whether the inner transport has low latency."""
        return self._transport.low_latency

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        try:
            self._transport.write(data)
        except LinkError as error:
            self._show("sent", data[: error.written or 0])
            raise
        self._show("sent", data)

    def write_some(self, data: bytes) -> int:
        """Send what is taken at once."""
        taken = self._transport.write_some(data)
        self._show("sent", data[:taken])
        return taken

    def read(self, timeout: float) -> bytes:
        """Return what has come."""
        data = self._transport.read(timeout)
        self._show("received", data)
        return data

    def fileno(self) -> int | None:
        """Return the descriptor of the inner transport."""
        return self._transport.fileno()

    def reopen(self) -> None:
        """Close and open the inner transport again; the tap stays."""
        self._transport.reopen()

    def close(self) -> None:
        """Close the inner transport. The caller ends the tap."""
        self._transport.close()

    def _show(self, direction: Literal["sent", "received"], data: bytes) -> None:
        if data:
            self._tap(direction, data, self._now())
