"""Write whole requests; if one is cut, remember which of its bytes the peer has."""

from __future__ import annotations

import threading
import time
from math import inf

from cobotwire.protocol.errors import LinkError
from cobotwire.session.alignment import Alignment
from cobotwire.transport.interface import PollableTransport, Transport
from cobotwire.transport.waiting import has_room

# The pause before the next attempt at a write that has a deadline, in seconds.
PAUSE_SECONDS = 0.001


class Writer:
    """Writes requests; if an earlier one was cut, first the bytes that end it.

    Attributes:
        lock: held by the caller of each method that writes, so that frames do not mix.
    """

    def __init__(self, transport: Transport, alignment: Alignment, deadline: float = inf) -> None:
        """Store the transport, its alignment, and the number of seconds that a call may take."""
        self._transport = transport
        # Checking the transport's type takes longer than a write, so it is done once.
        self._pollable = transport if isinstance(transport, PollableTransport) else None
        self._alignment = alignment
        self._deadline = deadline
        self.lock = threading.Lock()

    def leave_to_parent(self) -> None:
        """Free the lock, which another thread of the parent may have held when it forked."""
        self.lock = threading.Lock()

    def is_free(self) -> bool:
        """Return whether a request may be written now: no thread writes.

        If calls have a deadline, the line must also take bytes now: waiting for that would take
        time, and could leave half a request.
        """
        return not self.lock.locked() and (self._deadline == inf or has_room(self._transport))

    def write(self, request: bytes, longest: float = inf) -> bytes:
        """Write a request, within ``longest`` seconds.

        Returns:
            What was written before it, to end an earlier request that was cut; mostly nothing.
        """
        align = self._alignment.align
        try:
            if longest == inf:
                self._transport.write(align + request)
            else:
                self._write_within(longest, align + request)
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
        if self._pollable is None:
            return self.write(request)
        align = self._alignment.align
        taken: int | None = None
        try:
            taken = self._pollable.write_some(align + request)
        finally:
            if taken != len(align + request):
                self._alignment.cut(align, request, taken)
        if taken < len(align + request):
            return None
        if align:
            self._alignment.end()
        return align

    def _write_within(self, seconds: float, data: bytes) -> None:
        transport, written = self._pollable, 0
        if transport is None:
            self._transport.write(data)
            return
        until = time.monotonic() + seconds
        while (written := written + transport.write_some(data[written:])) < len(data):
            if time.monotonic() >= until:
                taken = f"only {written} of {len(data)} bytes were taken in {seconds:.3f} s"
                raise LinkError(transport.url, f"cannot be written: {taken}", written)
            time.sleep(PAUSE_SECONDS)
