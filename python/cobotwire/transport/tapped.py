"""A link that shows what passes through it, as it passes: what a recording stands on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from cobotwire.errors import LinkError
from cobotwire.transport.interface import Link
from cobotwire.transport.timing import times_of

# Called with the direction, the bytes of one read or write, and its second: that of
# ``time.monotonic()``, or of the link's own clock.
Tap = Callable[[Literal["sent", "heard"], bytes, float], None]


class TappedLink:
    """A :class:`cobotwire.transport.interface.Link` around another one.

    The tap sees each chunk at its own time, as no hook above the framer can: half a frame when it
    comes, and of a write that fails the bytes that were taken. It is called in the thread that
    reads or writes, and must not raise.
    """

    def __init__(self, link: Link, tap: Tap) -> None:
        self._link, self._tap = link, tap
        self.url, self.kind = link.url, link.kind
        self._now = times_of(link).now

    def __repr__(self) -> str:
        return f"<{type(self).__name__} around {self._link!r}>"

    @property
    def clock(self) -> object:
        """As the link says; None: it goes by the system's."""
        return getattr(self._link, "clock", None)

    @property
    def low_latency(self) -> bool:
        """As the link says."""
        return self._link.low_latency

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        try:
            self._link.write(data)
        except LinkError as error:
            self._show("sent", data[: error.written])
            raise
        self._show("sent", data)

    def write_some(self, data: bytes) -> int:
        """Send what is taken at once."""
        taken = self._link.write_some(data)
        self._show("sent", data[:taken])
        return taken

    def read(self, timeout: float) -> bytes:
        """What has come."""
        data = self._link.read(timeout)
        self._show("heard", data)
        return data

    def fileno(self) -> int | None:
        """As the link says."""
        return self._link.fileno()

    def reopen(self) -> None:
        """Close and open again; the tap sees what comes after as it saw what came before."""
        self._link.reopen()

    def close(self) -> None:
        """Give the link back. The tap is the caller's."""
        self._link.close()

    def _show(self, direction: Literal["sent", "heard"], data: bytes) -> None:
        if data:
            self._tap(direction, data, self._now())
