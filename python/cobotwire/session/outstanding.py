"""Outstanding replies: those to requests that were given up, or were sent more than once.

A late reply looks like the reply to the next request of the same command. So that request is held
until no late reply can come any more. It is not sent earlier, even if a late reply has
come: some lines double replies, so the late reply may be a copy of the reply to another attempt.

What an ended session leaves outstanding on its port is persisted, for the next session there.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cobotwire.codec.interface import Frame
from cobotwire.session.alignment import Part
from cobotwire.session.matching import can_reply_to, replies_differ
from cobotwire.session.pending import PendingRequest
from cobotwire.session.request import EncodedRequest


class OutstandingReply(NamedTuple):
    """A reply to ``request`` that may come before the second ``until``."""

    request: EncodedRequest
    until: float


class OutstandingReplies:
    """The outstanding replies of one transport.

    Attributes:
        replies: oldest first; some may have expired.
    """

    def __init__(self) -> None:
        self.replies: tuple[OutstandingReply, ...] = ()

    def expect(self, request: EncodedRequest, until: float) -> None:
        """Expect a reply to ``request`` until that second."""
        self.replies = (*self.replies, OutstandingReply(request, until))

    def expect_late(self, pending: PendingRequest, received: int) -> None:
        """Expect a late reply to each attempt, except for the first ``received`` ones."""
        self.replies = (*self.replies, *late_replies(pending, received))

    def settle(self, reply: OutstandingReply) -> None:
        """Stop expecting a reply."""
        self.replies = tuple(other for other in self.replies if other is not reply)

    def drop_expired(self, now: float) -> None:
        """Forget the replies that are too late to come."""
        self.replies = tuple(reply for reply in self.replies if reply.until > now)

    def held_until(self, request: EncodedRequest) -> float | None:
        """Return until when a late reply can be mistaken for this request's; None: no reply can."""
        alike = (r.until for r in self.replies if not replies_differ(r.request, request))
        return max(alike, default=None)

    def find(self, frame: Frame, now: float) -> OutstandingReply | None:
        """Return the oldest outstanding reply that a frame can be, or None."""
        for reply in self.replies:
            if reply.until > now and can_reply_to(frame, reply.request):
                return reply
        return None

    def has_command(self, frame: Frame) -> bool:
        """Return whether a reply of the frame's command is outstanding."""
        return any(reply.request.can_have_reply(frame) for reply in self.replies)


def late_replies(pending: PendingRequest, received: int) -> list[OutstandingReply]:
    """Return the outstanding replies to a request's attempts after the first ``received`` ones."""
    return [
        OutstandingReply(pending.request, sent_at + pending.policy.grace)
        for sent_at in pending.attempt_times[received:]
    ]


class LateFrame(NamedTuple):
    """A request that was sent; its reply may still come before the second ``until``."""

    request: bytes
    until: float


class PersistedState(NamedTuple):
    """Replies that may still come, and what the peer may hold of a request that was cut.

    Attributes:
        late: the requests with outstanding replies; times are those of the port's clock.
        parts: every part of a request that the peer may hold.
    """

    late: tuple[LateFrame, ...] = ()
    parts: tuple[Part, ...] = ()

    @property
    def empty(self) -> bool:
        """Whether no reply is outstanding and no request was cut."""
        return not self.late and not self.parts


def merged(states: Iterable[PersistedState]) -> PersistedState:
    """Return what several sessions left on the same port."""
    found = list(states)
    return PersistedState(
        tuple(late for each in found for late in each.late),
        tuple(part for each in found for part in each.parts),
    )
