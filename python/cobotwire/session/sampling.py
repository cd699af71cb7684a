"""When a stream sends its requests; times are numbers, and there is no clock, thread or port.

A stream is cut into periods. Period k begins at ``started + k / rate`` and has at most one sample.
Its requests are sent when it begins, or up to half a period later; after that the period is missed,
and the stream waits for the next one. Missed samples are therefore not sent later in bursts: two
samples are requested at least half a period apart. If another thread's request or an outstanding
reply delays a sample, it belongs to the period that begins nearest to the time at which it is sent.

A sample is requested only when the consumer waits for one; while the consumer is busy, periods are
missed. So there is no queue that could grow, and no sample is older than the call that returns it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import Any, NamedTuple

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Table
from cobotwire.session.pending import RetryPolicy
from cobotwire.session.request import EncodedRequest
from cobotwire.session.sample import Reading, Sample, StreamReport

HIGHEST_RATE = 1000.0


class Poll(NamedTuple):
    """A request of a stream, ready to be sent; ``wait`` is its deadline in seconds, or None."""

    request: Request[Any]
    encoded: EncodedRequest
    policy: RetryPolicy
    wait: float | None


class Sampler:
    """The periods of one stream; ``now`` is the caller's seconds and never goes back.

    For each sample the stream calls :meth:`plan`, waits until that time, sends the requests, and
    calls :meth:`answered` or :meth:`unanswered`; if it is stopped in between, :meth:`interrupted`.
    """

    def __init__(self, requests: tuple[Request[Any], ...], rate: float) -> None:
        """Take the requests of each period in the order of sending, and ``rate`` in hertz.

        Raises:
            UsageError: the rate is not allowed.
        """
        right = isinstance(rate, int | float) and not isinstance(rate, bool)
        if not right or not 0 < rate <= HIGHEST_RATE:
            allowed = f"samples a second, above 0 and up to {HIGHEST_RATE:g}"
            raise UsageError("rate", rate, allowed)
        self._requests = requests
        self._rate = float(rate)
        self._started: float | None = None
        # The first period that is neither used nor missed.
        self._next = 0
        # When the last sample was handed over; None while one is waited for.
        self._free: float | None = 0.0
        self._samples = self._unanswered = self._overrun = self._unread = 0

    def plan(self, now: float) -> float:
        """Return when to send the next requests; periods that have passed are missed.

        Raises:
            UsageError: another consumer waits for a sample.
        """
        if self._free is None:
            message = "a stream has one consumer, and one waits already; open another stream"
            raise UsageError("stream", message=message)
        if self._started is None:
            self._started = self._free = now
        elif self._nearest(now) > self._next:
            overrun, unread = self._passed(now)
            self._overrun += overrun
            self._unread += unread
            self._next += overrun + unread
        self._free = None
        at = self._started + self._next / self._rate
        return at if at > now else now

    def answered(self, readings: Sequence[Reading[Any]], now: float) -> Sample:
        """Return the sample of a period in which every request has its reply."""
        period = self._nearest(readings[0].requested_at)
        if period > self._next:
            # The periods before it were missed, and not because of the consumer.
            self._overrun += period - self._next
        else:
            period = self._next
        sample = Sample(self._samples, period, self._requests, tuple(readings))
        self._samples += 1
        self._next = period + 1
        self._free = now
        return sample

    def unanswered(self, now: float) -> None:
        """Count a period in which a request had no reply in time, or an illegal one."""
        self._unanswered += 1
        self._next += 1
        # More periods were missed because of that request, not because of the consumer.
        self._overrun += (late := max(0, self._nearest(now) - self._next))
        self._next += late
        self._free = now

    def interrupted(self, now: float) -> None:
        """Note that the consumer was interrupted while it waited; it may continue later."""
        self._free = now

    def report(self, now: float) -> StreamReport:
        """Return the report until ``now``; nothing changes."""
        overrun, unread = self._passed(now)
        return StreamReport(
            self._rate,
            self._samples,
            self._unanswered,
            self._overrun + overrun,
            self._unread + unread,
        )

    def _passed(self, now: float) -> tuple[int, int]:
        """Return how many periods passed unused while the stream was busy, and while it was not."""
        if self._started is None:
            return 0, 0
        passed = max(0, self._nearest(now) - self._next)
        busy_until = now if self._free is None else self._free
        overrun = min(passed, max(0, self._nearest(busy_until) - self._next))
        return overrun, passed - overrun

    def _nearest(self, now: float) -> int:
        """Return the period that begins nearest to a time; of two the earlier."""
        assert self._started is not None, "a stream starts with its first plan"
        return ceil((now - self._started) * self._rate - 0.5)


def check_requests(requests: Sequence[Request[Any]], table: Table) -> None:
    """Check that a stream may send these requests.

    Raises:
        UsageError: there is none, one comes twice, or one is not a query of the edition.
    """
    if not requests:
        raise UsageError("requests", message=f"stream() needs a query: {_queries(table)}")
    for index, request in enumerate(requests):
        name = f"requests[{index}]"
        if not isinstance(request, Request):
            raise UsageError(name, request, "a request such as GetAngles()")
        command = table.command(request.command)
        if command.safety != "query" or not command.requires_reply:
            message = f"{name} is {command.name}, which is not a query; a stream can send "
            raise UsageError(name, request, message=message + _queries(table))
        if request in requests[:index]:
            message = f"{name} repeats {request!r}; a stream sends each query once"
            raise UsageError(name, request, message=message)


def _queries(table: Table) -> str:
    return ", ".join(c.name for c in table.commands if c.safety == "query" and c.requires_reply)
