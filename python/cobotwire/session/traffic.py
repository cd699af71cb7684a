"""What goes over the line, as watchers and recordings see it: whole frames, texts, and noise."""

from __future__ import annotations

from typing import Literal, NamedTuple

from cobotwire.codec.interface import Noise
from cobotwire.session.events import Expired, SessionEvent


class Traffic(NamedTuple):
    """One thing that went over the line.

    Every byte that is heard stands in exactly one of these, in the order of the line; what is sent,
    in one when it has been written.

    Attributes:
        time: ``time.monotonic()`` seconds: behind the write, or when the last of it was read.
        direction: ``sent`` or ``heard``.
        data: a frame (with the text that follows some), or a span of noise.
        event: what the session makes of it; None for what is sent.
    """

    time: float
    direction: Literal["sent", "heard"]
    data: bytes
    event: SessionEvent | None = None


def heard(event: SessionEvent, now: float) -> Traffic | None:
    """An event as traffic; None where its bytes were told before, or there are none."""
    if isinstance(event, Noise):
        return Traffic(now, "heard", event.data, event)
    if isinstance(event, Expired) or event.frame is None:
        return None
    return Traffic(now, "heard", event.frame.data, event)
