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
from functools import partial
from typing import Any

from cobotwire.client.opening import PortOpener
from cobotwire.client.port_memory import PortMemory
from cobotwire.client.traffic import TrafficListener, TrafficListeners
from cobotwire.codec.interface import Event, Frame
from cobotwire.protocol.errors import LinkError
from cobotwire.session import EncodedRequest, Exchange, Pending, PendingRequest, RetryPolicy
from cobotwire.session.alone import Begun
from cobotwire.session.turns import DRAIN_SECONDS
from cobotwire.transport import forks
from cobotwire.transport.interface import LendingTransport, PollableTransport, Transport
from cobotwire.transport.timing import times_of

# The longest that the reading thread waits before it checks whether others have queued a request.
SLICE_SECONDS = 0.02
# How long the leader leaves the line to a thread that writes, before it reads again.
TURN_SECONDS = 0.0005
# A write that takes longer than this was held up by a full line.
SLOW_WRITE_SECONDS = 0.005
# The longest that the others wait before they check whether a thread reads.
CHECK_SECONDS = 0.05


# Sends a request that is alone: its arguments are those of ``NativeFramer.swap`` after the alarm.
Swap = Callable[
    [float, bytes, str, threading.Lock, Callable[[bytes, int], object]],
    tuple[Frame, dict[str, Any]] | list[Event] | None,
]


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
        self._swap = _swap_of(self._transport, exchange)
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
            self._await(pending)
            pending.result()
            return
        try:
            if self._leads():
                self._drain(now + DRAIN_SECONDS)
        finally:
            self._resign()

    def call(
        self, request: EncodedRequest, policy: RetryPolicy, wait: float | None
    ) -> dict[str, Any]:
        """Send a request, and return the fields of its reply.

        Raises:
            CobotwireError: the reason why there is no reply.
        """
        swap = self._swap
        if swap is not None and request.plain and self.listeners.silent:
            fields = self._call_alone(swap, request, policy, wait)
            if fields is not None:
                return fields
        return self.request(request, policy, wait).result()

    def _call_alone(
        self, swap: Swap, request: EncodedRequest, policy: RetryPolicy, wait: float | None
    ) -> dict[str, Any] | None:
        """Do what :meth:`call` does, with one native call that writes, waits, reads and decodes.

        If anything but the reply comes, the request goes on as any other does.

        Returns:
            None if the request was not sent, because it is not alone on the line.
        """
        alone = self._exchange.alone
        begun: Begun | None = None
        pending: PendingRequest | None = None
        seconds = request.command.deadline_ms / 1000 if wait is None else wait
        # The first attempt takes at least the share of all of them.
        attempt = seconds / policy.attempts
        try:
            with self._state:
                if self._leader is None:
                    begun = alone.begin(request, self.now(), policy.grace)
                if begun is None:
                    return None
                self._leader = threading.get_ident()
            with self._reading:
                self._turns += 1
                found = swap(
                    attempt if attempt < SLICE_SECONDS else SLICE_SECONDS,
                    request.frame,
                    request.command.name,
                    self._writing,
                    self._finish_write,
                )
                if found is None:
                    alone.end_unsent()
                    return None
                if isinstance(found, tuple):
                    frame, fields = found
                    if alone.end(frame):
                        return fields
                    found = [frame]
                with self._state:
                    now = self.now()
                    pending = PendingRequest(request, wait, policy, begun[1])
                    events = alone.resume(begun, pending, found, now)
                self.listeners.received(events, now)
            self._wait(pending)
            return pending.result()
        finally:
            if pending is not None:
                self._leave(pending)
            elif begun is not None:
                if alone.under_way:
                    with self._state:
                        alone.settle(begun)
                self._resign()

    def _finish_write(self, request: bytes, written: int) -> None:
        """Write the rest of a request of which so many bytes were taken; the lock is held."""
        assert isinstance(self._transport, LendingTransport), "it has lent its descriptor"
        try:
            self._transport.finish_write(request, written)
        except LinkError as error:
            error.written = self._alignment.cut(b"", request, error.written)
            raise
        except BaseException:
            self._alignment.cut(b"", request, None)
            raise

    def request(
        self, request: EncodedRequest, policy: RetryPolicy, wait: float | None
    ) -> PendingRequest:
        """Send a request and wait until it is done.

        Raises:
            LinkError: the transport is gone.
        """
        pending = PendingRequest(request, wait, policy, self.now())
        try:
            self._start(pending)
            self._wait(pending)
        finally:
            self._leave(pending)
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

    def _await(self, pending: Pending) -> None:
        try:
            self._wait(pending)
        finally:
            self._leave(pending)

    def _wait(self, pending: Pending) -> None:
        while not pending.done:
            if self._leads():
                self._turn(SLICE_SECONDS)
            else:
                self._follow(pending)

    def _leave(self, pending: Pending) -> None:
        """Have Ctrl-C and a vanished transport leave everything ready for the next call."""
        if not pending.done:
            with self._state:
                self._exchange.give_up(pending)
        self._resign()

    def _start(self, pending: PendingRequest) -> None:
        """Send a request at once if nothing else is under way; otherwise queue it.

        What has come already is read first, without waiting.
        """
        exchange = self._exchange
        if not self._leads():
            with self._state:
                exchange.enqueue(pending)
            return
        with self._reading:
            self._turns += 1
            data = self._read(0.0)
            if data or self._writing.locked():
                with self._state:
                    exchange.enqueue(pending)
                self._advance(data)
                return
            with self._writing:
                with self._state:
                    now = self.now()
                    frame = exchange.begin(pending, now)
                align = self._write_request(pending, frame, now) if frame else None
            if align is not None:
                self.listeners.sent(align, frame)

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
        with self._reading:
            self._turns += 1
            with self._state:
                idle = self._exchange.idle_seconds(self.now())
            self._advance(self._read(longest if idle is None else min(idle, longest)))

    def _read(self, longest: float) -> bytes:
        try:
            return self._transport.read(longest)
        except LinkError as error:
            self._lose(error)
            raise

    def _advance(self, data: bytes) -> None:
        """Take what was read, let time pass, and send the request that is next."""
        exchange, now = self._exchange, self.now()
        with self._state:
            events, outgoing = exchange.advance(data, now)
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
            align = self._write_request(pending, data, now)
        if align is not None:
            self.listeners.sent(align, data)

    def _write_request(self, pending: PendingRequest, data: bytes, now: float) -> bytes | None:
        """Write a request that the exchange gave at ``now``; the caller holds the lock.

        Returns:
            As :meth:`_write`; None if the request was not written.
        """
        try:
            return self._write_if_free(data) if pending.repeated else self._write(data)
        except LinkError as error:
            with self._state:
                self._exchange.fail_waiting(error)
            return None
        finally:
            if self.now() - now > SLOW_WRITE_SECONDS:
                with self._state:
                    self._exchange.written(pending, self.now())

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


def _swap_of(transport: Transport, exchange: Exchange) -> Swap | None:
    """Return the native function that sends a request and takes its reply; None: there is none."""
    native: Any = getattr(exchange.framer, "swap", None)
    if native is None or not isinstance(transport, LendingTransport) or not transport.lends:
        return None
    return partial(transport.lend, native)
