"""Outstanding replies: those to requests that were given up, or were sent more than once.

A late reply looks like the reply to the next request of the same command. So that request is held
until the late reply is too late to come at all. It is not sent earlier, even if a late reply has
come: some lines double replies, so the one that came may be a copy of another attempt's. The
functions take a list of outstanding replies, oldest first, and change nothing.
"""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.codec.interface import Frame
from cobotwire.session.matching import can_reply_to, replies_differ
from cobotwire.session.request import EncodedRequest


class OutstandingReply(NamedTuple):
    """A reply to ``request`` that may come before the second ``until``."""

    request: EncodedRequest
    until: float


def without_expired(outstanding: list[OutstandingReply], now: float) -> list[OutstandingReply]:
    """Return those that can still come."""
    return [reply for reply in outstanding if reply.until > now]


def held_until(outstanding: list[OutstandingReply], request: EncodedRequest) -> float | None:
    """Return until when a late reply can be mistaken for this request's; None: no reply can."""
    alike = (reply.until for reply in outstanding if not replies_differ(reply.request, request))
    return max(alike, default=None)


def find(outstanding: list[OutstandingReply], frame: Frame, now: float) -> OutstandingReply | None:
    """Return the oldest outstanding reply that a frame can be; None: no such reply is expected."""
    for reply in outstanding:
        if reply.until > now and can_reply_to(frame, reply.request):
            return reply
    return None
