"""A request that is alone on its line, for which the client writes and reads in one native call.

While it is under way, nothing else knows of it. If the reply is all that comes, it just ends.
Otherwise it is resumed, and goes on as any other request does.
"""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.codec.interface import Event, Framer
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

    A native call (``LoneCalls``) checks that nothing else is under way, and sets ``begun``,
    ``alignment.last_request`` and ``echo.latest``. If the reply is all that comes, it resets
    ``begun``, which ends the request. Otherwise its caller calls :meth:`resume`, or
    :meth:`end_unsent` if it could not be sent. If it does neither, after Ctrl-C, say,
    :meth:`settle` is called.

    Attributes:
        begun: the request that has begun, and has neither ended nor been resumed.
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
        self._framer, self.alignment = framer, alignment
        self.turns, self._replies = turns, replies
        self.outstanding_replies, self.acks, self.echo = outstanding, acks, echo
        self.begun: Begun | None = None

    def outstanding(self) -> list[OutstandingReply]:
        """Return the reply to the request that is under way, if there is one."""
        if self.begun is None:
            return []
        request, sent_at, _, grace = self.begun
        return [OutstandingReply(request, sent_at + grace)]

    def wait_on(self, pending: PendingRequest, now: float) -> int | None:
        """Have a request wait for its reply that the caller is about to send; it is not resumed.

        Returns:
            How many bytes have been fed by then. None if anything is under way, or a reply
            outstanding.
        """
        if not self.is_free():
            return None
        fed = self._framer.fed
        self.echo.sent(pending.request, fed)
        pending.begin(now, fed)
        self.turns.last, self.alignment.last_request = pending, pending.request.frame
        return fed

    def take_back(self, pending: PendingRequest) -> None:
        """Note that the request of :meth:`wait_on` was not sent; it may be queued now."""
        self.turns.last = None
        pending.attempt_times = ()

    def is_free(self) -> bool:
        """Return whether nothing is under way, and no reply is outstanding."""
        turns = self.turns
        last = turns.last
        return not (
            (last is not None and not last.done)
            or turns.queue
            or self.outstanding_replies.replies
            or self.acks.waiting
            or self.begun is not None
            or self.alignment.align
        )

    def end_unsent(self, begun: Begun) -> None:
        """Note that a request was not sent, unless another one has begun since."""
        if begun is self.begun:
            self.begun = None

    def resume(
        self, begun: Begun, pending: PendingRequest, received: Sequence[Event], now: float
    ) -> list[SessionEvent]:
        """Go on with the request as with any other; return what was received."""
        _, sent_at, offset, _ = begun
        pending.begin(sent_at, offset)
        self.turns.last, self.begun = pending, None
        self._replies.chunk_at = offset
        return self._replies.sort(received, now)

    def note(self, frame: bytes, offset: int) -> None:
        """Note the last request that was sent without the session; it may have its reply."""
        self.alignment.last_request, self.echo.latest = frame, (frame, offset)

    def resume_sent(self, pending: PendingRequest, sent_at: float, offset: int) -> None:
        """Go on with that request, which has no reply yet, as with any other."""
        pending.begin(sent_at, offset)
        self.turns.last = pending

    def settle(self, begun: Begun | None = None) -> None:
        """Expect the reply to a request of which the caller is gone."""
        if self.begun is not None and (begun is None or begun is self.begun):
            (request, sent_at, _, grace), self.begun = self.begun, None
            self.outstanding_replies.expect(request, sent_at + grace)
