"""Send the requests of a stream when its periods begin, in the consumer's thread."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from cobotwire.protocol.errors import ProtocolError, ReplyTimeout
from cobotwire.session import EncodedRequest, PendingRequest, RetryPolicy
from cobotwire.session.request import result_of
from cobotwire.session.sample import Reading
from cobotwire.session.sampling import Poll

# The longest sleep, after which a stream checks whether it was closed.
CHECK_SECONDS = 0.05


class Poller:
    """Sends the requests of one stream, one after another, the first one when its period begins."""

    def __init__(
        self,
        now: Callable[[], float],
        sleep: Callable[[float], None],
        request: Callable[[EncodedRequest, RetryPolicy, float | None], PendingRequest],
        closed: Callable[[], bool],
    ) -> None:
        """Take methods of a connection; ``closed`` returns whether the stream is closed."""
        self._now, self._sleep, self._request = now, sleep, request
        self._closed = closed

    def readings(self, polls: Sequence[Poll], at: float) -> list[Reading[Any]] | None:
        """Send each request in turn, the first one at a given time.

        Returns:
            A reading for each request; an empty list if a request had no legal reply; None if the
            stream was closed before.

        Raises:
            LinkError: the transport is gone.
            ReplyTimeout: a simulated arm cannot reply.
        """
        while (left := at - self._now()) > 0:
            self._sleep(min(left, CHECK_SECONDS))
            if self._closed():
                return None
        try:
            return [self._reading(poll) for poll in polls]
        except (ReplyTimeout, ProtocolError) as error:
            if isinstance(error, ReplyTimeout) and error.refusal:
                raise
            return []

    def _reading(self, poll: Poll) -> Reading[Any]:
        pending = self._request(poll.encoded, poll.policy, poll.wait)
        fields, requested_at, replied_at = pending.timed_reply()
        return Reading(result_of(poll.request, fields), requested_at, replied_at)
