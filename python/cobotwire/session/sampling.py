"""When a stream asks: slots of one period each; no clock, thread or port in here.

Slot k belongs to the moment ``started + k * period``, and has one sample at most. It is asked at
its moment, or up to half a period later; after that it is missed, and the moment of the next one is
waited for. So nothing is caught up in bursts: two samples are asked half a period apart at least. A
sample that was held up (by another thread's question, or by an owed reply) counts for the slot that
is nearest to its asking.

Nothing is asked for that is not wanted: while the consumer is busy, slots pass unread. So there is
no queue that could grow, and no sample is older than its wait for the consumer's call.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

from cobotwire.errors import UsageError
from cobotwire.session.sample import Query, Reading, Sample, StreamReport

HIGHEST_RATE = 1000.0


class Sampler:
    """The slots of one stream; ``now`` is the caller's seconds and never goes back.

    The driver takes turns with it: :meth:`plan`, wait until then, ask, :meth:`answered` or
    :meth:`unanswered`. What breaks off in between is told by :meth:`interrupted`.
    """

    def __init__(self, queries: tuple[Query, ...], rate: float) -> None:
        """Queries in the order of asking; ``rate`` in slots a second.

        Raises:
            UsageError: the rate is none.
        """
        if (
            not isinstance(rate, int | float)
            or isinstance(rate, bool)
            or not 0 < rate <= HIGHEST_RATE
        ):
            allowed = f"samples a second, above 0 and up to {HIGHEST_RATE:g}"
            raise UsageError("rate", rate, allowed)
        self._queries = queries
        self._rate = float(rate)
        self._started: float | None = None
        # The first slot that is neither used nor missed.
        self._slot = 0
        # When the last sample was handed over; None while one is waited for.
        self._free: float | None = 0.0
        self._samples = self._unanswered = self._overrun = self._unread = 0

    def plan(self, now: float) -> float:
        """The consumer wants a sample: when it is to be asked for; slots that passed are missed.

        Raises:
            UsageError: another consumer waits for one.
        """
        if self._free is None:
            raise UsageError("stream", "in use", "one consumer; others have streams of their own")
        if self._started is None:
            self._started = self._free = now
        overrun, unread = self._passed(now)
        self._overrun += overrun
        self._unread += unread
        self._slot += overrun + unread
        self._free = None
        return max(now, self._started + self._slot / self._rate)

    def answered(self, readings: Sequence[Reading], now: float) -> Sample:
        """Every question of the slot is answered."""
        slot = max(self._slot, self._nearest(readings[0].asked_at))
        sample = Sample(self._samples, slot, self._queries, tuple(readings))
        # Counted here, since the slots before were neither used nor is the consumer to blame.
        self._overrun += slot - self._slot
        self._samples += 1
        self._slot = slot + 1
        self._free = now
        return sample

    def unanswered(self, now: float) -> None:
        """A question of the slot was not answered in time, or not as the edition allows."""
        self._unanswered += 1
        self._slot += 1
        # What passed meanwhile passed because of that question, not of the consumer.
        self._overrun += (late := max(0, self._nearest(now) - self._slot))
        self._slot += late
        self._free = now

    def interrupted(self, now: float) -> None:
        """The consumer was interrupted while it waited; it may go on later."""
        self._free = now

    def report(self, now: float) -> StreamReport:
        """How it went until ``now``; changes nothing."""
        overrun, unread = self._passed(now)
        return StreamReport(
            self._rate,
            self._samples,
            self._unanswered,
            self._overrun + overrun,
            self._unread + unread,
        )

    def _passed(self, now: float) -> tuple[int, int]:
        """Slots that have passed unused since: while the stream was busy, and the consumer."""
        if self._started is None:
            return 0, 0
        passed = max(0, self._nearest(now) - self._slot)
        busy_until = now if self._free is None else self._free
        overrun = min(passed, max(0, self._nearest(busy_until) - self._slot))
        return overrun, passed - overrun

    def _nearest(self, now: float) -> int:
        """The slot whose moment is nearest; of two the earlier."""
        assert self._started is not None, "a stream starts with its first plan"
        return ceil((now - self._started) * self._rate - 0.5)
