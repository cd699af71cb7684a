"""A query that is alone on its line, in one native call that does all of it.

It holds the locks, writes, waits, reads and decodes. It decides only the usual case, that what
comes is one frame and the reply. Everything else goes on step by step.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf

from cobotwire.client.steps import SLICE_SECONDS, Steps
from cobotwire.codec.interface import Event
from cobotwire.session import Answer, EncodedRequest, PendingRequest, RetryPolicy
from cobotwire.session.alone import Begun
from cobotwire.transport.interface import LendingTransport, Transport
from cobotwire.transport.waiting import native_calls

Lone = Callable[["NativeCall", EncodedRequest, RetryPolicy, float | None, float], Answer | None]


def native_call(steps: Steps, transport: Transport, deadline: float = inf) -> NativeCall | None:
    """Return how the native module makes calls; None: transport or codec do not allow it.

    Calls may take ``deadline`` seconds.
    """
    exchange = steps.exchange
    native, framer = native_calls(), exchange.framer
    # The codec can be the reference all the same.
    if native is None or not hasattr(framer, "read_reply"):
        return None
    if not isinstance(transport, LendingTransport) or not transport.lends:
        return None
    transport.lend()
    lone = native.lone_calls(framer, transport, steps, exchange.alone, SLICE_SECONDS)
    return NativeCall(steps, lone.call, deadline)


class NativeCall:
    """The native call of one connection, and what it calls if more happens than the reply comes.

    Attributes:
        lone: ``lone(native_call, request, policy, wait, at)`` sends a plain request at a moment, or
            at once if it has passed, and returns its reply; None if it was not sent, because it is
            not alone on the line.
        finish_write: writes the rest of a request of which a part was taken.
        leave: gives up a request that was resumed.
    """

    def __init__(self, steps: Steps, lone: Lone, deadline: float) -> None:
        self._steps, self._deadline = steps, deadline
        self._alone = steps.exchange.alone
        self.lone = lone
        self.finish_write = steps.writer.finish_write
        self.leave = steps.leave

    def resume(
        self, begun: Begun, received: Sequence[Event], wait: float | None, policy: RetryPolicy
    ) -> PendingRequest:
        """Go on with a request after something else has come than its reply.

        The lock of reading is held.
        """
        steps = self._steps
        pending: PendingRequest | None = None
        try:
            with steps.state:
                now = steps.now()
                ends_by = begun[1] + self._deadline
                pending = PendingRequest(begun[0], wait, policy, begun[1], ends_by)
                events = self._alone.resume(begun, pending, received, now)
            steps.listeners.received(events, now)
            return pending
        except BaseException:
            if pending is not None:
                steps.leave(pending)
            raise

    def wait(self, pending: PendingRequest) -> Answer:
        """Wait until a request is done that was resumed; return its reply."""
        try:
            self._steps.wait(pending)
            return pending.answer()
        finally:
            self._steps.leave(pending)

    def abandon(self, begun: Begun, sent: bool) -> None:
        """Note that Ctrl-C has ended a call, and whether anything was sent since it began."""
        steps, alone = self._steps, self._alone
        with steps.state:
            if sent:
                alone.settle(begun)
            else:
                # A signal ended the wait for its moment.
                alone.end_unsent(begun)
        steps.leading.resign()
