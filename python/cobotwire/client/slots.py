"""Send the requests of a stream at the moments of its slots, in the consumer's thread."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any

from cobotwire.protocol.errors import ProtocolError, ReplyTimeout
from cobotwire.session import Answer, EncodedRequest, RetryPolicy
from cobotwire.session.request import result_of
from cobotwire.session.sample import Reading
from cobotwire.session.sampling import Poll

# The longest sleep, after which a stream checks whether it was closed.
CHECK_SECONDS = 0.05
# A thread that gets its turn this late has waited for a busy one.
LATE_SECONDS = 0.001
# How much earlier than its moment a call begins then: in switch intervals, and seconds at most.
EARLY_INTERVALS, EARLIEST_SECONDS = 1.5, 0.01


class Slots:
    """Sends the requests of one stream, one after another, each at its moment.

    A busy thread of Python lets another one run after a switch interval, 5 ms by default. Beside
    one, the stream takes its turn that much earlier: it begins the call, which waits for the
    moment, and needs its next turn only for the reply. Meanwhile the call has the line, so calls
    of other threads wait. They would do so anyway for a turn of their own.
    """

    def __init__(
        self,
        now: Callable[[], float],
        sleep: Callable[[float], None],
        answer: Callable[[EncodedRequest, RetryPolicy, float | None, float], Answer],
        closed: Callable[[], bool],
    ) -> None:
        """Take methods of a connection, and what tells whether the stream is closed."""
        self._now, self._sleep, self._answer = now, sleep, answer
        self._closed = closed
        # How much earlier than its moment a call begins, in seconds.
        self._early = 0.0

    def close(self) -> None:
        """Do nothing: whether the stream is closed is checked before each call."""

    def readings(self, polls: Sequence[Poll], at: float) -> list[Reading[Any]] | None:
        """Send each request in turn, the first one at a moment.

        Returns:
            No readings if a request had no legal reply; None if the stream was closed by then.

        Raises:
            LinkError: the transport is gone.
            ReplyTimeout: the arm, which is simulated, cannot reply.
        """
        readings = []
        for poll in polls:
            try:
                reading = self.reading(poll, at)
            except (ReplyTimeout, ProtocolError) as error:
                if isinstance(error, ReplyTimeout) and error.refusal:
                    raise
                return []
            if reading is None:
                return None
            readings.append(reading)
        return readings

    def reading(self, poll: Poll, at: float) -> Reading[Any] | None:
        """Send a request at a moment; return its result, or None if the stream is closed by then.

        Raises:
            ReplyTimeout, ProtocolError: there is no legal reply.
            LinkError: the transport is gone.
        """
        now, slept = self._now, False
        while (left := at - self._early - now()) > 0:
            self._sleep(left if left < CHECK_SECONDS else CHECK_SECONDS)
            slept = True
            if self._closed():
                return None
        begun = now()
        fields, requested_at, replied_at = self._answer(poll.encoded, poll.policy, poll.wait, at)
        late = now() - replied_at > LATE_SECONDS or (slept and begun - at > LATE_SECONDS)
        early = sys.getswitchinterval() * EARLY_INTERVALS
        self._early = min(early, EARLIEST_SECONDS) if late else 0.0
        return Reading(result_of(poll.request, fields), requested_at, replied_at)
