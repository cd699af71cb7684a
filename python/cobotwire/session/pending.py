"""The one question that waits for its reply."""

from __future__ import annotations

from cobotwire.codec.interface import Message
from cobotwire.session.listening import TextListener
from cobotwire.session.request import Request
from cobotwire.table import Command


class Pending:
    """A question that was asked; all times are the caller's seconds.

    Attributes:
        since: where in the stream its replies begin at the earliest.
        asked: when it was asked, and asked again.
        candidate: a copy of the question that reads as its answer.
    """

    __slots__ = (
        "asked",
        "candidate",
        "command",
        "deadline",
        "request",
        "since",
        "text",
        "tries",
        "turn",
    )

    def __init__(self, request: Request, now: float, wait: float, tries: int, since: int) -> None:
        self.request = request
        self.command: Command = request.command
        self.asked = [now]
        self.deadline = now + wait
        self.tries = tries
        self.turn = wait / tries
        self.since = since
        form = self.command.text
        self.text = None if form is None else TextListener(form)
        self.candidate: Message | None = None

    @property
    def over_at(self) -> float:
        """When the wait ends, unless more is heard."""
        if self.text is None:
            return self.deadline
        silent_at = self.text.silent_at
        if silent_at is None:
            return self.deadline
        # A text that has begun may be finished behind the deadline; babble may not go on for ever.
        return min(silent_at, self.deadline + self.text.silence)

    @property
    def again_at(self) -> float | None:
        """When it is to be asked again; None: no more. Late drivers leave a try its time."""
        if len(self.asked) >= self.tries:
            return None
        at = self.asked[-1] + self.turn
        return at if at < self.deadline else None
