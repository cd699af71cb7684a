"""One transport that many threads share.

Writing is separate from reading. A thread that sends a one-way request writes it at once. Of the
threads that wait for replies, one leads: it reads for all, feeds the exchange, sends the next
request and wakes the others. When its own reply has come, another takes over. So a lone caller
reads its own reply without a switch of threads, and a one-way request never waits for another
thread's reply.

Ctrl-C may come anywhere. Locks are taken by ``with`` and held for moments, so none stays locked.
Which thread leads is only a number, and nothing relies on it: a leader that makes no progress is
replaced, and if it was only slow, the lock of the reader keeps the bytes in order.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from cobotwire.client.opening import PortOpener
from cobotwire.client.port_memory import PortMemory
from cobotwire.client.traffic import TrafficListener, TrafficListeners
from cobotwire.protocol.errors import LinkError
from cobotwire.session import EncodedRequest, Exchange, Pending, PendingRequest, RetryPolicy
from cobotwire.session.exchange import DRAIN_SECONDS
from cobotwire.transport import forks
from cobotwire.transport.interface import PollableTransport
from cobotwire.transport.timing import times_of

# The longest that the reading thread waits before it checks whether others have queued a request.
SLICE_SECONDS = 0.02
# How long the leader leaves the line to a thread that writes, before it reads again.
TURN_SECONDS = 0.0005
# A write that takes longer than this was held up by a full line.
SLOW_WRITE_SECONDS = 0.005
# The longest that the others wait before they check whether a thread reads.
CHECK_SECONDS = 0.05


class Connection:
    """An exchange over a transport; every method may be called from any thread."""

    def __init__(
        self,
        opener: PortOpener,
        exchange: Exchange,
        trace: TrafficListener | None,
    ) -> None:
        """Open the port, unless it is an open transport.

        Raises:
            UsageError: the port, the baud rate or the path of the recording is not allowed.
            LinkError: the port does not exist, or cannot be opened.
        """
        self._port = opener.open()
        self._transport = self._port.transport
        self.url = self._transport.url
        self.now, self.sleep, _ = times_of(self._transport)
        self.listeners = TrafficListeners(trace, self.url, self.now)
        self._exchange = exchange
        self._alignment = exchange.alignment
        # Held around every step of the exchange.
        self._state = threading.Lock()
        # Held while a frame is written, so that frames do not mix. Taken before the other one.
        self._writing = threading.Lock()
        # Held from reading bytes until they are sorted and reported, so that they stay in order.
        # Reentrant, since a traffic listener may call the arm. Taken before the other two.
        self._reading = threading.RLock()
        self._leader: int | None = None
        # How often leaders have read; a leader that does not count on is gone.
        self._turns = 0
        self._followers: list[threading.Lock] = []
        self._memory = PortMemory(self._transport)
        exchange.take_over(self._memory.recall())
        forks.watch(self)

    def send(self, request: EncodedRequest, ack_within: float | None) -> None:
        """Send a one-way request at once; wait ``ack_within`` seconds for its acknowledgement."""
        with self._writing:
            with self._state:
                now = self.now()
                data, pending = self._exchange.send_one_way(request, now, ack_within)
            align = self._write(data)
        self.listeners.sent(align, data)
        if pending is not None:
            self._await(pending, SLICE_SECONDS)
            pending.result()
            return
        try:
            if self._leads():
                self._drain(now + DRAIN_SECONDS)
        finally:
            self._resign()

    def request(
        self, request: EncodedRequest, policy: RetryPolicy, wait: float | None
    ) -> PendingRequest:
        """Send a request and wait until it is done.

        Raises:
            LinkError: the transport is gone.
        """
        pending = PendingRequest(request, wait, policy, self.now())
        # What has come already is read first, without waiting.
        self._await(pending, 0.0, queued=False)
        return pending

    def listen(self, seconds: float, done: Callable[[], bool] | None = None) -> None:
        """Read what comes without a request, and report it to the traffic listeners.

        Until then, ``done`` ends the wait as soon as it returns True after something has come.

        Raises:
            LinkError: the transport is gone.
        """
        until = self.now() + seconds
        while (left := until - self.now()) > 0 and not (done and done()):
            try:
                leads = self._leads()
                if leads:
                    self._turn(min(left, SLICE_SECONDS))
            finally:
                self._resign()
            if not leads:
                # In real time, whatever the transport's: another thread is waited for.
                time.sleep(min(left, CHECK_SECONDS))

    def close(self) -> None:
        """Close the transport. The arm is sent nothing. Closing twice is harmless.

        Raises:
            CaptureError: the recording is incomplete; everything is closed all the same.
        """
        self._transport.close()
        with self._state:
            leftover = self._exchange.leave(self.now())
        self._memory.leave(leftover)
        self._port.close_recording()

    def leave_to_parent(self) -> None:
        """Free what other threads of the parent held; in a forked child the transport is closed."""
        self._state, self._writing = threading.Lock(), threading.Lock()
        self._reading = threading.RLock()
        self._leader, self._followers = None, []
        self._memory.leave_to_parent()

    def _await(self, pending: Pending, longest: float, queued: bool = True) -> None:
        try:
            if not queued:
                assert isinstance(pending, PendingRequest)
                with self._state:
                    self._exchange.enqueue(pending)
            while not pending.done:
                if self._leads():
                    self._turn(longest)
                    longest = SLICE_SECONDS
                else:
                    self._follow(pending)
        finally:
            # Ctrl-C and a vanished transport leave everything ready for the next call.
            if not pending.done:
                with self._state:
                    self._exchange.give_up(pending)
            self._resign()

    def _leads(self) -> bool:
        """Return whether this thread leads; it does from now on if no other one does."""
        me = threading.get_ident()
        if self._leader != me:
            with self._state:
                if self._leader is None:
                    self._leader = me
        return self._leader == me

    def _resign(self) -> None:
        if self._leader == threading.get_ident():
            self._leader = None
            self._wake_followers()

    def _turn(self, longest: float) -> None:
        """Read once, let time pass, and send the request that is next."""
        exchange = self._exchange
        with self._reading:
            self._turns += 1
            if longest:
                with self._state:
                    idle = exchange.idle_seconds(self.now())
                if idle is not None and idle < longest:
                    longest = idle
            try:
                data = self._transport.read(longest)
            except LinkError as error:
                self._lose(error)
                raise
            now = self.now()
            with self._state:
                # What has come is received before time passes, or it would count as late.
                events = exchange.receive(data, now) if data else []
                events += exchange.wake(now)
                outgoing = exchange.has_outgoing(now)
            if outgoing:
                if self._writing.locked():
                    # Another thread writes, perhaps to a full line. Deadlines go on meanwhile.
                    time.sleep(TURN_SECONDS)
                else:
                    self._send_request(drained=not data)
            if events:
                self._wake_followers()
                self.listeners.received(events, now)

    def _send_request(self, drained: bool) -> None:
        with self._writing:
            with self._state:
                now = self.now()
                data = self._exchange.outgoing(now, drained)
                pending = self._exchange.sent_last
            if not data or pending is None:
                return
            try:
                align = self._write_if_free(data) if pending.repeated else self._write(data)
            except LinkError as error:
                with self._state:
                    self._exchange.fail_waiting(error)
                return
            finally:
                if self.now() - now > SLOW_WRITE_SECONDS:
                    with self._state:
                        self._exchange.written(pending, self.now())
        if align is not None:
            self.listeners.sent(align, data)

    def _write(self, request: bytes) -> bytes:
        """Write a request; the caller holds the lock.

        Returns:
            What was written before it, to end an earlier request that was cut; mostly nothing.
        """
        align = self._alignment.align
        try:
            self._transport.write(align + request)
            if align:
                self._alignment.end()
        except LinkError as error:
            error.written = self._alignment.cut(align, request, error.written)
            raise
        except BaseException:
            self._alignment.cut(align, request, None)
            raise
        return align

    def _write_if_free(self, request: bytes) -> bytes | None:
        """Write a repeated query, unless the line is full: its deadline would pass meanwhile.

        Returns:
            As :meth:`_write`; None if the line did not take all of it.
        """
        if not isinstance(self._transport, PollableTransport):
            return self._write(request)
        align = self._alignment.align
        taken: int | None = None
        try:
            taken = self._transport.write_some(align + request)
        finally:
            if taken != len(align + request):
                self._alignment.cut(align, request, taken)
        if taken < len(align + request):
            return None
        if align:
            self._alignment.end()
        return align

    def _drain(self, until: float) -> None:
        """Read what has come, so that no buffer overflows while only one-way requests are sent."""
        with self._reading:
            while data := self._transport.read(0):
                now = self.now()
                with self._state:
                    events = self._exchange.receive(data, now)
                self.listeners.received(events, now)
                if now >= until:
                    return

    def _lose(self, error: LinkError) -> None:
        """End every request: the transport is gone."""
        now = self.now()
        with self._state:
            events = self._exchange.fail(error, now)
        self._wake_followers()
        self.listeners.received(events, now)
        self.listeners.lost(error)

    def _follow(self, pending: Pending) -> None:
        """Wait until the leader has something, or another thread must lead."""
        baton = threading.Lock()
        baton.acquire()
        with self._state:
            leader, turns = self._leader, self._turns
            if pending.done or leader is None:
                return
            self._followers.append(baton)
        if not baton.acquire(timeout=CHECK_SECONDS):
            with self._state:
                if (leader, turns) == (self._leader, self._turns):
                    # Ctrl-C took it out of its loop before it could resign, or it is very slow.
                    self._leader = None

    def _wake_followers(self) -> None:
        if not self._followers:
            return
        with self._state:
            batons, self._followers = self._followers, []
        for baton in batons:
            baton.release()
