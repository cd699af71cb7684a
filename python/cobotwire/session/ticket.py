"""What a caller holds while its question or order is in course."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.errors import CobotwireError, LinkError, ReplyTimeout
from cobotwire.session.acks import Due
from cobotwire.session.heard import Heard
from cobotwire.session.policy import RetryPolicy
from cobotwire.session.request import Request, in_words


class Ticket:
    """A question, or an order whose acknowledgement is wanted.

    Attributes:
        done: whether it is over; then :meth:`result` tells how it went.
        waker: called once when it is over, by whoever feeds the conversation.
    """

    __slots__ = ("_error", "_fields", "_heard", "done", "request", "waker")

    def __init__(self, request: Request) -> None:
        self.request = request
        self.done = False
        self._heard: Heard | None = None
        self.waker: Callable[[], object] | None = None
        self._fields: dict[str, Any] = {}
        self._error: CobotwireError | None = None

    @property
    def heard(self) -> Heard:
        """What came meanwhile, and was no answer. Most calls hear nothing, and make none."""
        if self._heard is None:
            self._heard = Heard()
        return self._heard

    def succeed(self, fields: dict[str, Any]) -> None:
        """It was answered."""
        self._fields = fields
        self._end()

    def fail(self, error: CobotwireError) -> None:
        """It will not be answered."""
        self._error = error
        self._end()

    def result(self) -> dict[str, Any]:
        """The fields of the reply, by name.

        Raises:
            CobotwireError: why there are none.
        """
        error = self._error
        if error is None:
            return self._fields
        if isinstance(error, LinkError):
            # One fault of the link may end many tickets: each thread raises an error of its own.
            raise LinkError(error.url, error.detail, error.written) from error
        raise error

    def silence(self, codec: Codec, waited: float, tries: int) -> ReplyTimeout:
        """That nothing came: what was asked, how often, and what was heard meanwhile."""
        words = in_words(self.request, codec)
        # Most calls that hear nothing have made none.
        heard = () if self._heard is None else self._heard.lines(codec, self.request.frame)
        return ReplyTimeout(self.request.command.name, waited, heard, tries, words)

    def _end(self) -> None:
        self.done = True
        if self.waker is not None:
            self.waker()


class Question(Ticket):
    """A question on its way: it waits its turn, is asked, and is over.

    Attributes:
        wait: seconds that the arm has to answer, from the first asking; None: the edition's.
        ready_since: when nothing but bytes to be read kept it from being asked.
        asked_at: when it was first sent; None: not yet.
        answered_at: when its reply was received; None: not yet, or never.
    """

    __slots__ = ("answered_at", "asked_at", "policy", "queued_at", "ready_since", "wait")

    def __init__(
        self, request: Request, wait: float | None, policy: RetryPolicy, now: float
    ) -> None:
        super().__init__(request)
        self.wait = wait
        self.policy = policy
        self.queued_at = now
        self.ready_since: float | None = None
        self.asked_at: float | None = None
        self.answered_at: float | None = None


class Order(Ticket):
    """An order that went out; it is over when it is acknowledged, or ``until`` then."""

    __slots__ = ("due", "sent_at", "until")

    def __init__(self, request: Request, due: Due, now: float, until: float) -> None:
        super().__init__(request)
        self.due = due
        self.sent_at = now
        self.until = until
