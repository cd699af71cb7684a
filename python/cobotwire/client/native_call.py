"""A query that is alone on its line, in one native call that writes, waits, reads and decodes.

It decides only the usual case, that what comes is one frame and the reply. Everything else goes on
step by step.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from cobotwire.client.steps import SLICE_SECONDS, Steps
from cobotwire.codec.interface import Event, Frame
from cobotwire.session import Answer, EncodedRequest, PendingRequest, RetryPolicy
from cobotwire.session.alone import Begun
from cobotwire.transport.interface import LendingTransport, Transport

# Sends a request that is alone: its arguments are those of ``NativeFramer.swap`` after the alarm.
Swap = Callable[
    [float, float, bytes, str, Any, Callable[[bytes, int], object]],
    tuple[Frame, dict[str, Any], float, float] | list[Event] | None,
]


def native_call(steps: Steps, transport: Transport) -> NativeCall | None:
    """Return how the native module makes calls; None: transport or codec do not allow it."""
    swap: Any = getattr(steps.exchange.framer, "swap", None)
    if swap is None or not isinstance(transport, LendingTransport) or not transport.lends:
        return None
    return NativeCall(steps, partial(transport.lend, swap))


class NativeCall:
    """Makes calls with one native call each, if they are alone on their line.

    Attributes:
        swap: the native call.
    """

    def __init__(self, steps: Steps, swap: Swap) -> None:
        self._steps = steps
        self._alone = steps.exchange.alone
        self.swap = swap

    def call(
        self, request: EncodedRequest, policy: RetryPolicy, wait: float | None, at: float = 0.0
    ) -> Answer | None:
        """Send a plain request at a moment, or at once if it has passed; return its reply.

        If anything but the reply comes, the request goes on as any other does.

        Returns:
            None if the request was not sent, because it is not alone on the line.
        """
        steps, alone = self._steps, self._alone
        leading = steps.leading
        # Native calls come with a native lock.
        lock: Any = steps.writer.lock
        begun: Begun | None = None
        pending: PendingRequest | None = None
        seconds = request.command.deadline_ms / 1000 if wait is None else wait
        # The first attempt takes at least the share of all of them.
        attempt = seconds / policy.attempts
        try:
            with steps.state:
                if leading.leader is None:
                    now = steps.now()
                    begun = alone.begin(request, now if now > at else at, policy.grace)
                if begun is None:
                    return None
                leading.leader = threading.get_ident()
                taken = lock.taken
            with steps.reading:
                leading.turns += 1
                found = self.swap(
                    at,
                    attempt if attempt < SLICE_SECONDS else SLICE_SECONDS,
                    request.frame,
                    request.command.name,
                    lock,
                    steps.writer.finish_write,
                )
                if found is None:
                    alone.end_unsent()
                    return None
                if isinstance(found, tuple):
                    frame, fields, requested_at, replied_at = found
                    if alone.end(frame):
                        return fields, requested_at, replied_at
                    found = [frame]
                with steps.state:
                    now = steps.now()
                    pending = PendingRequest(request, wait, policy, begun[1])
                    events = alone.resume(begun, pending, found, now)
                steps.listeners.received(events, now)
            steps.wait(pending)
            return pending.answer()
        finally:
            if pending is not None:
                steps.leave(pending)
            elif begun is not None:
                if alone.under_way:
                    with steps.state:
                        if lock.taken == taken:
                            # It was not sent: a signal ended the wait for its moment.
                            alone.end_unsent()
                        else:
                            alone.settle(begun)
                leading.resign()
