"""What a referee has heard so far, and what became of the answers."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from cobotwire.codec.interface import Codec, Message, Noise
from cobotwire.conformance.report import Exchange
from cobotwire.session.device import Asked, DeviceEvent, Malformed, Told
from cobotwire.table import Command

# Rules look back a few seconds; on a line that carries 678 requests a second these are enough.
REMEMBERED = 512
SHOWN = 6


@dataclass(slots=True, eq=False)
class Heard:
    """Something that the client sent. Seconds since the run began.

    ``answer`` is what an arm says to it. ``answered_at`` is when the last byte of that went out;
    None: it has not yet, or never does.
    """

    at: float
    event: DeviceEvent
    answer: bytes = b""
    answered_at: float | None = None

    @property
    def data(self) -> bytes:
        """Its bytes; none for the text behind a request, which was told as noise before."""
        if isinstance(self.event, Told):
            return b""
        return self.event.data if isinstance(self.event, Noise) else self.event.frame.data

    @property
    def message(self) -> Message | None:
        """What a legal request says."""
        return self.event.message if isinstance(self.event, Asked) else None

    @property
    def command(self) -> Command | None:
        """The command of a legal request."""
        return self.event.message.command if isinstance(self.event, Asked) else None

    @property
    def is_question(self) -> bool:
        """Whether a reply is due."""
        return self.command is not None and self.command.answers

    @property
    def is_order(self) -> bool:
        """Whether it changes something, so that it must not be sent twice."""
        return self.command is not None and self.command.safety != "query"


@dataclass(slots=True)
class Past:
    """All that is remembered; ``powered`` tells whether the arm stands under power."""

    codec: Codec
    # A reply comes within so many seconds or never, as field notes have it.
    patience: float = 0.03
    powered: bool = True
    heard: deque[Heard] = field(default_factory=lambda: deque(maxlen=REMEMBERED))

    def backwards(self, since: float) -> Iterator[Heard]:
        """What was heard before, the newest first, not older than ``since``."""
        for each in reversed(self.heard):
            if each.at < since:
                return
            yield each

    @property
    def last(self) -> Heard | None:
        """What was heard right before."""
        return self.heard[-1] if self.heard else None

    def unanswered(self, since: float) -> Iterator[Heard]:
        """Questions whose reply has not gone out, the newest first."""
        return (h for h in self.backwards(since) if h.is_question and h.answered_at is None)

    def text_due(self) -> Heard | None:
        """The request behind which a text must follow, while that has not come."""
        for each in reversed(self.heard):
            if isinstance(each.event, Told):
                return None
            if isinstance(each.event, Asked):
                return each if each.event.message.command.request_text is not None else None
        return None

    def evidence(self, now: Heard) -> tuple[Exchange, ...]:
        """The last exchanges, in their order, as the referee's side saw them."""
        shown: list[Exchange] = []
        for each in [*list(self.heard)[1 - SHOWN :], now]:
            if each.data:
                shown.append(Exchange(each.at, "heard", each.data, _note(each)))
            if each.answered_at is not None:
                shown.append(Exchange(each.answered_at, "sent", each.answer))
        return tuple(sorted(shown, key=lambda exchange: exchange.at))


def _note(heard: Heard) -> str:
    event = heard.event
    if isinstance(event, Noise):
        return event.reason
    if isinstance(event, Malformed):
        return str(event.error)
    return heard.command.name if heard.command is not None else ""
