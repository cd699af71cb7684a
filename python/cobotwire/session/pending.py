"""Requests in progress, and how often each is sent: the caller's choice."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any, NamedTuple, Self

from cobotwire.codec.interface import Codec, DecodedMessage, Frame, Noise
from cobotwire.protocol.errors import (
    CobotwireError,
    LinkError,
    ReplyTimeout,
    UsageError,
    WaitedFor,
)
from cobotwire.protocol.table import Command
from cobotwire.session.events import FrameEvent
from cobotwire.session.received import ReceivedMeanwhile
from cobotwire.session.request import EncodedRequest, as_call
from cobotwire.session.text import TextCollector

# The latest reply that was seen on a real line came 727 ms after its request.
GRACE_SECONDS = 1.0
MOST_ATTEMPTS = 100


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


class _RetryFields(NamedTuple):
    attempts: int
    shortest_attempt: float
    grace: float


class RetryPolicy(_RetryFields):
    """Splits the ``timeout`` of a query into attempts. Only queries are ever sent again.

    On real lines a reply comes within some 30 ms or never, so sending again beats waiting longer.
    Attempts do not extend the timeout: three attempts within 500 ms are one every 167 ms.

    Attributes:
        attempts: how often a query is sent at most, 1..100; 1 never repeats it.
        shortest_attempt: seconds that each attempt gets at least, above 0; a short timeout has
            fewer attempts.
        grace: seconds after an attempt during which its late reply is still expected, 0 or more.
            A later request whose reply would look the same is held until then, even if a late reply
            has come: it may be a copy.
    """

    __slots__ = ()

    def __new__(
        cls, attempts: int = 3, shortest_attempt: float = 0.1, grace: float = GRACE_SECONDS
    ) -> Self:
        """Check the values."""
        if not _is_number(attempts) or attempts not in range(1, MOST_ATTEMPTS + 1):
            raise UsageError("retry.attempts", attempts, f"a whole number 1..{MOST_ATTEMPTS}")
        if not _is_number(shortest_attempt) or not 0 < shortest_attempt < 3600:
            allowed = "seconds above 0 and below 3600"
            raise UsageError("retry.shortest_attempt", shortest_attempt, allowed)
        if not _is_number(grace) or not 0 <= grace < 3600:
            raise UsageError("retry.grace", grace, "seconds from 0 to below 3600")
        return super().__new__(cls, attempts, shortest_attempt, grace)

    def attempts_of(self, command: Command, wait: float) -> int:
        """Return the number of attempts into which the ``wait`` of a request is split.

        A command that is not a query gets one. So does a query with a text reply: two texts in a
        row look like a longer one.
        """
        if command.safety != "query" or command.text is not None:
            return 1
        # 0.3 s are three times 0.1 s, in spite of binary fractions.
        fitting = int(wait / self.shortest_attempt + 1e-9) or 1
        return fitting if fitting < self.attempts else self.attempts


class Pending:
    """A request whose caller waits.

    Attributes:
        request: what is sent.
        done: whether it has ended; :meth:`result` then returns its outcome.
        ends_by: the deadline of its caller; inf: there is none.
    """

    __slots__ = ("_error", "_fields", "_on_done", "_received", "done", "ends_by", "request")

    def __init__(self, request: EncodedRequest, ends_by: float = inf) -> None:
        self.request = request
        self.done = False
        self.ends_by = ends_by
        self._fields: dict[str, Any] = {}
        self._error: CobotwireError | None = None
        self._on_done: Callable[[], object] | None = None
        # Made with the first event: most requests receive nothing but their reply.
        self._received: ReceivedMeanwhile | None = None

    def when_done(self, call: Callable[[], object]) -> None:
        """Have ``call`` called once when the reply has come, or the wait has failed."""
        self._on_done = call

    def result(self) -> dict[str, Any]:
        """Return the fields of the reply by name.

        Raises:
            CobotwireError: the reason why there is no reply.
        """
        error = self._error
        if error is None:
            return self._fields
        if isinstance(error, LinkError):
            # One fault of the transport ends many requests; each thread raises its own error.
            raise LinkError(error.url, error.detail, error.written) from error
        raise error

    def note(self, event: FrameEvent | Noise) -> None:
        """Remember an event that was not the reply, for the text of a timeout."""
        if self._received is None:
            self._received = ReceivedMeanwhile()
        self._received.add(event)

    def succeed(self, fields: dict[str, Any]) -> None:
        """End it with a reply."""
        self._fields = fields
        self._end()

    def fail(self, error: CobotwireError) -> None:
        """End it with an error."""
        self._error = error
        self._end()

    def expire(
        self, codec: Codec, waited: float, attempts: int, waited_for: WaitedFor | None = None
    ) -> None:
        """End it with a ReplyTimeout, which lists what was received meanwhile."""
        frame, command = self.request.frame, self.request.command
        received = () if self._received is None else self._received.lines(codec, frame, command)
        call = as_call(self.request, codec)
        self.fail(ReplyTimeout(command.name, waited, received, attempts, call, waited_for))

    def cancel(self) -> None:
        """End it without a result: its caller does not wait any longer."""
        self.done = True

    def _end(self) -> None:
        self.done = True
        if self._on_done is not None:
            self._on_done()


class PendingRequest(Pending):
    """A request that waits for its turn, then for its reply.

    Attributes:
        policy: how often it is sent.
        queued_at: when it was submitted.
        undrained_since: since when unread bytes have kept it from being sent; inf: they have not.
        attempt_times: when it was sent; empty while it waits for its turn.
        requested_at: the time just before it was first written.
        offset: where in the received stream its reply can begin at the earliest.
        candidate: a copy of the request that is also a legal reply.
        text: collects a reply that is text outside any frame.
        replied_at: when its reply was received; None: not yet, or never.
    """

    __slots__ = (
        "_attempts",
        "_deadline",
        "_wait",
        "attempt_times",
        "candidate",
        "offset",
        "policy",
        "queued_at",
        "replied_at",
        "requested_at",
        "text",
        "undrained_since",
    )

    def __init__(
        self,
        request: EncodedRequest,
        wait: float | None,
        policy: RetryPolicy,
        now: float,
        ends_by: float = inf,
    ) -> None:
        """Queue a request; the arm has ``wait`` seconds to reply, None: as the edition states."""
        super().__init__(request, ends_by)
        command = request.command
        self._wait = command.deadline_ms / 1000 if wait is None else wait
        self._attempts = policy.attempts_of(command, self._wait)
        self._deadline = inf
        self.policy = policy
        self.queued_at = now
        self.undrained_since = inf
        self.attempt_times: tuple[float, ...] = ()
        self.requested_at = 0.0
        self.offset = 0
        self.candidate: DecodedMessage | None = None
        self.text = None if command.text is None else TextCollector(command.text)
        self.replied_at: float | None = None

    @property
    def ends_at(self) -> float:
        """When the wait ends unless more is received."""
        if self.text is None or self.text.ends_at is None:
            return self._deadline
        # A text that has begun may end after the deadline, but endless noise must not extend it.
        return min(self.text.ends_at, self._deadline + self.text.silence)

    @property
    def repeat_at(self) -> float:
        """When it is to be sent again; inf: not again.

        An attempt that was sent late still gets its full time.
        """
        times = self.attempt_times
        if len(times) >= self._attempts:
            return inf
        at = times[-1] + self._wait / self._attempts
        return at if at < self._deadline else inf

    @property
    def repeated(self) -> bool:
        """Whether it was sent more than once."""
        return len(self.attempt_times) > 1

    def note_undrained(self, now: float) -> None:
        """Note that unread bytes keep it from being sent."""
        self.undrained_since = min(self.undrained_since, now)

    def begin(self, now: float, offset: int) -> None:
        """Note that it is sent for the first time; its reply can begin at ``offset``."""
        self.offset = offset
        self._deadline = now + self._wait
        self.requested_at = now
        self.attempt_times = (now,)

    def repeat(self, now: float) -> None:
        """Note that it is sent again."""
        self.attempt_times = (*self.attempt_times, now)

    def written(self, now: float) -> None:
        """Note that the last attempt was written only now."""
        *earlier, _ = self.attempt_times
        if not earlier:
            self._deadline = now + self._wait
        self.attempt_times = (*earlier, now)

    def accepts(self, frame: Frame) -> bool:
        """Return whether a frame has its command id and began after it was sent."""
        request = self.request
        expected = frame.offset >= self.offset and bool(request.command.reply)
        return expected and request.can_have_reply(frame)

    def keep_candidate(self, message: DecodedMessage) -> None:
        """Keep a copy of the request, which counts if no other reply comes."""
        self.candidate = message

    def reply(self, fields: dict[str, Any], now: float) -> None:
        """End it with the reply that was received at ``now``."""
        self.replied_at = now
        self.succeed(fields)

    def timed_reply(self) -> tuple[dict[str, Any], float, float]:
        """Return the fields of the reply by name, when its request was sent, and when it was read.

        Raises:
            CobotwireError: the reason why there is no reply.
        """
        fields, replied_at = self.result(), self.replied_at
        assert replied_at is not None, "a request without a reply has raised"
        return fields, self.requested_at, replied_at
