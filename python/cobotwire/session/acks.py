"""Acknowledgements that may come: of orders that an edition says may be acknowledged.

They carry nothing but the id of the order, so that the oldest order of that id is taken to be the
one that is meant. Where some acknowledgements are lost, an order may be taken to be unacknowledged
although it was; never the other way round, as far as each comes within its time.
"""

from __future__ import annotations

from collections import deque

from cobotwire.codec.interface import Codec, Frame, Message
from cobotwire.errors import ProtocolError
from cobotwire.session.policy import GRACE_SECONDS
from cobotwire.session.request import Request, fits

# Some firmware acknowledges a motion at its end only.
MOTION_SECONDS = 60.0


class Due:
    """An order whose acknowledgement may come ``until`` then."""

    __slots__ = ("copied", "done", "request", "until")

    def __init__(self, request: Request, until: float) -> None:
        self.request = request
        self.until = until
        # A copy of the order came: a bare acknowledgement of an order without data, or an echo.
        self.copied = False
        self.done = False


class Acks:
    """The orders that were sent lately, by their ids, oldest first."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._due: dict[int, deque[Due]] = {}

    def expect(self, request: Request, now: float, wait: float = 0.0) -> Due:
        """An order goes out; its acknowledgement is expected for ``wait`` seconds at least."""
        usual = MOTION_SECONDS if request.command.safety == "motion" else GRACE_SECONDS
        due = Due(request, now + max(wait, usual))
        queue = self._due.setdefault(request.command.id, deque())
        # Each is looked at once when it is old: however many orders go out, little is kept.
        while queue and queue[0].until <= now:
            queue.popleft()
        queue.append(due)
        return due

    def note_copy(self, frame: Frame) -> None:
        """The first copy of an order came, which is its acknowledgement unless the line echoes."""
        for due in self._due.get(frame.command, ()):
            if due.request.frame == frame.data and not due.copied:
                due.copied = True
                return

    def match(self, frame: Frame, now: float) -> tuple[Due, Message] | None:
        """The order that a frame acknowledges; None: it acknowledges none."""
        queue = self._due.get(frame.command, ())
        for due in list(queue):
            if due.until <= now:
                self._due[frame.command].remove(due)
                continue
            try:
                message = self._codec.decode("reply", frame.data, of=due.request.command.name)
            except ProtocolError:
                continue
            if fits(message, due.request):
                self._due[frame.command].remove(due)
                return due, message
        return None
