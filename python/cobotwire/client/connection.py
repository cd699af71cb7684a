"""Share one transport among many threads; blocking clients call this."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from math import inf

from cobotwire.client.firmware import ReportedFirmware
from cobotwire.client.leading import CHECK_SECONDS
from cobotwire.client.opening import PortOpener
from cobotwire.client.persisted_state import PersistedSession
from cobotwire.client.polling import Poller
from cobotwire.client.steps import SLICE_SECONDS, TURN_SECONDS, Steps
from cobotwire.client.traffic import TrafficListener, TrafficListeners
from cobotwire.session import EncodedRequest, Exchange, PendingRequest, RetryPolicy
from cobotwire.session.exchange import DRAIN_SECONDS
from cobotwire.transport import forks
from cobotwire.transport.timing import times_of


class Connection:
    """An exchange over a transport; every method may be called from any thread."""

    def __init__(
        self,
        opener: PortOpener,
        exchange: Exchange,
        trace: TrafficListener | None,
        deadline: float,
    ) -> None:
        """Open the port, unless it is an open transport.

        Calls may take ``deadline`` seconds; ``inf``: there is no limit.

        Raises:
            UsageError: the port, the baud rate or the path of the recording is not allowed.
            LinkError: the port does not exist, or cannot be opened.
        """
        self._port = opener.open()
        self._transport = self._port.transport
        self.url = self._transport.url
        self.now, self.sleep, self.real = times_of(self._transport)
        self.firmware = ReportedFirmware()
        self.listeners = TrafficListeners(trace, self.url, self.now)
        self._exchange = exchange
        # Held by follow(), so that only one runs at a time.
        self.follows = threading.Lock()
        self._deadline = deadline
        self._steps = Steps(self._transport, exchange, self.listeners, self.now, deadline)
        self._persisted = PersistedSession(self._transport, self._steps.persist)
        exchange.restore(self._persisted.recall())
        forks.watch(self)

    def send(
        self, request: EncodedRequest, ack_within: float | None, deadline: float | None = None
    ) -> None:
        """Send a one-way request at once; wait ``ack_within`` seconds for its acknowledgement.

        ``deadline`` replaces the deadline of other calls.
        """
        steps, called_at = self._steps, self.now()
        ends_by = called_at + (self._deadline if deadline is None else deadline)
        while self.now() < ends_by < inf and not steps.writer.is_free():
            time.sleep(TURN_SECONDS)
        with steps.writer.lock:
            with steps.state:
                now = self.now()
                if now >= ends_by:
                    raise self._exchange.unsent(request, now - called_at)
                data, pending = self._exchange.send_one_way(request, now, ack_within, ends_by)
            align = steps.writer.write(data, ends_by - now)
        self.listeners.sent(align, data)
        if pending is not None:
            try:
                steps.wait(pending)
            finally:
                steps.leave(pending)
            self.firmware.result(pending)
            return
        try:
            if steps.leading.take_lead():
                steps.drain(now + DRAIN_SECONDS)
        finally:
            steps.leading.resign()

    def request(
        self,
        request: EncodedRequest,
        policy: RetryPolicy,
        wait: float | None,
        deadline: float | None = None,
    ) -> PendingRequest:
        """Send a request and wait until it is done.

        ``deadline`` limits this call in addition to the deadline of the client.

        Raises:
            LinkError: the transport is gone.
        """
        steps = self._steps
        now = self.now()
        longest = self._deadline if deadline is None else min(deadline, self._deadline)
        pending = PendingRequest(request, wait, policy, now, now + longest)
        try:
            steps.start(pending)
            steps.wait(pending)
        finally:
            steps.leave(pending)
        return pending

    def poller(self, closed: Callable[[], bool]) -> Poller:
        """Return a poller, which sends the requests of a stream until ``closed`` returns True."""
        return Poller(self.now, self.sleep, self.request, closed)

    def listen(self, seconds: float, done: Callable[[], bool] | None = None) -> None:
        """Read what comes without a request, and report it to the traffic listeners.

        The wait ends early if ``done`` returns True after something has come.

        Raises:
            LinkError: the transport is gone.
        """
        steps, until = self._steps, self.now() + seconds
        while (left := until - self.now()) > 0 and not (done and done()):
            try:
                leads = steps.leading.take_lead()
                if leads:
                    steps.turn(min(left, SLICE_SECONDS))
            finally:
                steps.leading.resign()
            if not leads:
                # In real time, not by the transport's clock: another thread is waited for.
                time.sleep(min(left, CHECK_SECONDS))

    def send_only_stops(self) -> None:
        """Send only ``stop`` and ``halt`` from now on; other calls of all threads get a LinkError.

        A request that another thread is writing now is written before the next stop.
        """
        with self._steps.state:
            self._exchange.send_only_stops(self.url)
        self._steps.leading.wake_followers()

    def close(self) -> None:
        """Close the transport. Nothing is sent to the arm. Closing twice is harmless.

        Raises:
            CaptureError: the recording is incomplete; everything is closed nevertheless.
        """
        try:
            self._transport.close()
        finally:
            self._persisted.end()
            self._port.close_recording()

    def leave_to_parent(self) -> None:
        """Free what other threads of the parent held; in a forked child the transport is closed."""
        self._steps.leave_to_parent()
        self._persisted.leave_to_parent()
