"""A request that is alone on its line, for which the client writes and reads in one native call.

While it is under way, nothing else knows of it. If the reply is all that comes, it just ends.
Otherwise it is resumed, and goes on as any other request does.
"""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.codec.interface import Event, Frame, Framer
from cobotwire.session.acks import Acks
from cobotwire.session.alignment import Alignment
from cobotwire.session.echo import EchoDetector
from cobotwire.session.events import SessionEvent
from cobotwire.session.outstanding import OutstandingReplies, OutstandingReply
from cobotwire.session.pending import PendingRequest
from cobotwire.session.replies import Replies
from cobotwire.session.request import EncodedRequest
from cobotwire.session.turns import Turns

# What has begun: a request, when, how many bytes had been fed by then, and for how many seconds
# after that its late reply is expected.
Begun = tuple[EncodedRequest, float, int, float]


class Alone:
    """The request that is alone on its line, if there is one.

    The caller of :meth:`begin` sends it on a drained line, feeds the framer what comes first, and
    calls :meth:`end` or :meth:`resume`, or :meth:`end_unsent` if it could not send it. If it does
    none of these, after Ctrl-C, say, it calls :meth:`settle`.
    """

    def __init__(
        self,
        framer: Framer,
        alignment: Alignment,
        turns: Turns,
        replies: Replies,
        outstanding: OutstandingReplies,
        acks: Acks,
        echo: EchoDetector,
    ) -> None:
        self._framer, self._alignment = framer, alignment
        self._turns, self._replies = turns, replies
        self._outstanding, self._acks, self._echo = outstanding, acks, echo
        self._begun: Begun | None = None

    @property
    def under_way(self) -> bool:
        """Whether a request has begun, and has neither ended nor been resumed."""
        return self._begun is not None

    def outstanding(self) -> list[OutstandingReply]:
        """Return the reply to the request that is under way, if there is one."""
        if self._begun is None:
            return []
        request, sent_at, _, grace = self._begun
        return [OutstandingReply(request, sent_at + grace)]

    def begin(self, request: EncodedRequest, now: float, grace: float) -> Begun | None:
        """Begin a request; return None if anything is under way, or a reply outstanding."""
        if not self._is_free():
            return None
        fed = self._framer.fed
        self._echo.sent(request, fed)
        self._alignment.last_request = request.frame
        self._begun = begun = request, now, fed, grace
        return begun

    def wait_on(self, pending: PendingRequest, now: float) -> int | None:
        """Have a request wait for its reply that the caller is about to send; it is not resumed.

        Returns:
            How many bytes have been fed by then. None if anything is under way, or a reply
            outstanding.
        """
        if not self._is_free():
            return None
        fed = self._framer.fed
        self._echo.sent(pending.request, fed)
        pending.begin(now, fed)
        self._turns.last, self._alignment.last_request = pending, pending.request.frame
        return fed

    def take_back(self, pending: PendingRequest) -> None:
        """Note that the request of :meth:`wait_on` was not sent; it may be queued now."""
        self._turns.last = None
        pending.attempt_times = ()

    def _is_free(self) -> bool:
        turns = self._turns
        last = turns.last
        return not (
            (last is not None and not last.done)
            or turns.queue
            or self._outstanding.replies
            or self._acks.waiting
            or self._begun is not None
            or self._alignment.align
        )

    def end(self, frame: Frame) -> bool:
        """Return whether the only frame that came is the reply; the codec has decoded it as such.

        If it may be a copy of another request, the caller resumes the request with the frame.
        """
        if not self._echo.sent_no_other(frame):
            return False
        self._begun = None
        return True

    def end_unsent(self) -> None:
        """Note that the request was not sent."""
        self._begun = None

    def resume(
        self, begun: Begun, pending: PendingRequest, received: Sequence[Event], now: float
    ) -> list[SessionEvent]:
        """Go on with the request as with any other; return what was received."""
        _, sent_at, offset, _ = begun
        pending.begin(sent_at, offset)
        self._turns.last, self._begun = pending, None
        self._replies.chunk_at = offset
        return self._replies.sort(received, now)

    def settle(self, begun: Begun | None = None) -> None:
        """Expect the reply to a request of which the caller is gone."""
        if self._begun is not None and (begun is None or begun is self._begun):
            (request, sent_at, _, grace), self._begun = self._begun, None
            self._outstanding.expect(request, sent_at + grace)
