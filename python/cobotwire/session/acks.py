"""Acknowledgements that may come: of orders that an edition says may be acknowledged.

They carry nothing but the id of the order. Where several orders of an id are out, and some
acknowledgements are lost, nobody can say whose one is. So an order counts as acknowledged when more
of them have come than the other orders can have caused. An order may seem to be unacknowledged
although it was; never the other way round, as far as each comes once and within its time.
"""

from __future__ import annotations

from collections import deque

from cobotwire.codec.interface import Codec, Frame, Message
from cobotwire.errors import ProtocolError
from cobotwire.session.policy import GRACE_SECONDS
from cobotwire.session.request import Request

# Some firmware acknowledges a motion at its end only.
MOTION_SECONDS = 60.0


class _Count:
    """The orders of one id."""

    __slots__ = ("heard", "open", "sent")

    def __init__(self) -> None:
        self.sent = 0
        self.heard = 0
        # Those whose acknowledgement may still come, oldest first.
        self.open: deque[Due] = deque()

    def forget(self, now: float) -> None:
        while self.open and self.open[0].until <= now:
            self.open.popleft()


class Due:
    """An order whose acknowledgement may come ``until`` then, from ``since`` of the stream on."""

    __slots__ = ("_before", "_count", "_heard", "copied", "request", "since", "until")

    def __init__(self, request: Request, until: float, since: int, count: _Count) -> None:
        self.request = request
        self.until = until
        self.since = since
        # A copy of the order came: a bare acknowledgement of an order without data, or an echo.
        self.copied = False
        self._count = count
        self._heard = count.heard
        # Orders that were sent before it are its rivals; those sent after it are counted then.
        self._before = len(count.open) - count.sent

    @property
    def done(self) -> bool:
        """Whether it was acknowledged, whoever the other acknowledgements belong to."""
        rivals = self._before + self._count.sent - 1
        return self._count.heard - self._heard > rivals

    def not_mine(self) -> None:
        """One had begun to come before this order was sent: it was caused by one of the rivals."""
        self._heard += 1
        self._before -= 1


class Acks:
    """The orders that were sent lately, by their ids."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._counts: dict[int, _Count] = {}

    def expect(self, request: Request, now: float, wait: float, since: int) -> Due:
        """An order goes out; its acknowledgement is expected for ``wait`` seconds at least.

        ``since`` is where in the stream that begins at the earliest.
        """
        usual = MOTION_SECONDS if request.command.safety == "motion" else GRACE_SECONDS
        count = self._counts.setdefault(request.command.id, _Count())
        count.forget(now)
        due = Due(request, now + max(wait, usual), since, count)
        count.open.append(due)
        count.sent += 1
        return due

    def note_copy(self, frame: Frame) -> None:
        """A copy of an order came, which is its acknowledgement unless the line echoes."""
        count = self._counts.get(frame.command)
        if count is not None and len(count.open) == 1 and count.open[0].request.frame == frame.data:
            count.open[0].copied = True

    def match(self, frame: Frame, now: float) -> tuple[Request, Message] | None:
        """The order that a frame acknowledges, the oldest if there are several; None: none."""
        count = self._counts.get(frame.command)
        if count is None:
            return None
        count.forget(now)
        if not count.open or frame.offset < count.open[0].since:
            return None
        request = count.open[0].request
        try:
            message = self._codec.decode("reply", frame.data, of=request.command.name)
        except ProtocolError:
            return None
        # One less may still come; whose it was, the next ones need not know.
        count.open.popleft()
        count.heard += 1
        for due in reversed(count.open):
            if due.since <= frame.offset:
                break
            due.not_mine()
        return request, message
