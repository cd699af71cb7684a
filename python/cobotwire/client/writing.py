"""Write requests whole, or remember what the peer has of one that was cut."""

from __future__ import annotations

from cobotwire.protocol.errors import LinkError
from cobotwire.session.alignment import Alignment
from cobotwire.transport.interface import LendingTransport, PollableTransport, Transport
from cobotwire.transport.waiting import has_room, line_lock


class Writer:
    """Writes requests, and before them what ends an earlier request that was cut.

    Attributes:
        lock: held by the caller of each method that writes, so that frames do not mix.
    """

    def __init__(self, transport: Transport, alignment: Alignment, limited: bool = False) -> None:
        self._transport = transport
        self._alignment = alignment
        self._limited = limited
        self.lock = line_lock()

    def is_free(self) -> bool:
        """Return whether a request may be written now: no thread writes.

        If calls are ``limited`` by a deadline, the line also takes bytes: to wait for that would
        take time, and would leave half a request.
        """
        return not self.lock.locked() and (not self._limited or has_room(self._transport))

    def write(self, request: bytes) -> bytes:
        """Write a request.

        Returns:
            What was written before it, to end an earlier request that was cut; mostly nothing.
        """
        align = self._alignment.align
        try:
            self._transport.write(align + request)
            if align:
                self._alignment.end()
        except LinkError as error:
            error.written = self._alignment.cut(align, request, error.written)
            raise
        except BaseException:
            self._alignment.cut(align, request, None)
            raise
        return align

    def write_if_free(self, request: bytes) -> bytes | None:
        """Write a repeated query, unless the line is full: its deadline would pass meanwhile.

        Returns:
            As :meth:`write`; None if the line did not take all of it.
        """
        if not isinstance(self._transport, PollableTransport):
            return self.write(request)
        align = self._alignment.align
        taken: int | None = None
        try:
            taken = self._transport.write_some(align + request)
        finally:
            if taken != len(align + request):
                self._alignment.cut(align, request, taken)
        if taken < len(align + request):
            return None
        if align:
            self._alignment.end()
        return align

    def finish_write(self, request: bytes, written: int) -> None:
        """Write the rest of a request of which ``written`` bytes were taken."""
        assert isinstance(self._transport, LendingTransport), "it has lent its descriptor"
        try:
            self._transport.finish_write(request, written)
        except LinkError as error:
            error.written = self._alignment.cut(b"", request, error.written)
            raise
        except BaseException:
            self._alignment.cut(b"", request, None)
            raise
