"""A peer between the host and another peer, that applies faults."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from cobotwire.codec.interface import Codec, Event, Frame, Noise
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command
from cobotwire.simulator.faults.chooser import Chooser
from cobotwire.simulator.faults.exchange import AppliedFault, Piece, Reply, Request, joined
from cobotwire.simulator.faults.fault import Context
from cobotwire.simulator.faults.faulty_connection import FaultyConnection
from cobotwire.simulator.peer import IDLE_SECONDS, Peer, PeerDisconnected, SharedPeer

Chosen = list[tuple[Chooser, Context]]


class FaultyPeer:
    """Passes requests to the other peer, and sends its replies, with the faults applied to both.

    It is a peer for a pty, a socket or memory. Bytes that the other peer sends later, unrequested,
    count as its reply to the last request.
    """

    def __init__(
        self,
        peer: Peer,
        codec: Codec,
        choosers: Sequence[Chooser],
        *,
        clock: Callable[[], float],
        on_fault: Callable[[AppliedFault], None] | None = None,
        on_reply: Callable[[int], None] | None = None,
        restart: Callable[[], None] | None = None,
    ) -> None:
        """Wrap ``peer``; :meth:`Scenario.wrap` creates one and explains the arguments."""
        self._peer = peer
        self._codec = codec
        self._choosers = choosers
        self._clock = clock
        self._on_fault = on_fault
        self._on_reply = on_reply
        self._connection = FaultyConnection(clock, restart or (lambda: None))
        self._began = clock()
        # What the host sent while it was stopped.
        self._kept = b""
        # Bytes that are due and not yet returned.
        self._due = b""
        self._last: Chosen = []
        self._replies = 0
        # When the other peer must be flushed.
        self._peer_due: float | None = None
        self._reset()

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        times = [self._connection.outlet.next, self._peer_due]
        if self._framer.pending:
            times.append(self._received_at + IDLE_SECONDS)
        if self._kept:
            times.append(self._connection.stopped_until)
        if self._connection.gone_from < math.inf:
            times.append(self._connection.gone_from)
        due = [time for time in times if time is not None]
        return max(0.0, min(due) - self._clock()) if due else None

    def receive(self, data: bytes) -> bytes:
        """Receive ``data``; return what is due by now."""
        self._pass_time()
        if self._connection.stopped:
            self._kept += data
        else:
            self._handle_bytes(data)
        return self._take()

    def flush(self) -> bytes:
        """Return what is due by now, without new data."""
        self._pass_time()
        return self._take()

    def forget_client(self) -> None:
        """Forget an incomplete request; replies that a fault has delayed still come."""
        self._kept = b""
        self._reset()
        if isinstance(self._peer, SharedPeer):
            self._peer.forget_client()

    def power_cycle(self) -> None:
        """Switch the arm off and on: it is no longer deaf, and has lost its state."""
        self._kept = b""
        self._connection.wake()
        self._reset()

    def _pass_time(self) -> None:
        now = self._clock()
        if now >= self._connection.gone_from:
            raise PeerDisconnected
        if self._kept and not self._connection.stopped:
            kept, self._kept = self._kept, b""
            self._handle_bytes(kept)
        if self._framer.pending and now >= self._received_at + IDLE_SECONDS:
            self._handle_events(self._framer.flush())
            self._malformed = False
        if self._peer_due is not None and now >= self._peer_due:
            self._send(self._peer.flush(), self._last, late=True)
            self._plan_flush()

    def _handle_bytes(self, data: bytes) -> None:
        self._received_at = self._clock()
        if self._connection.deaf:
            self._report_lost_request(data)
            self._reset()
            return
        self._handle_events(self._framer.feed(data))

    def _reset(self) -> None:
        """Forget an incomplete request, and what was chosen for it."""
        self._framer = self._codec.framer("request", accept_unknown=True)
        self._received_at = self._clock()
        # Whether the last event was malformed input: more noise then belongs to the same input.
        self._malformed = False
        self._text_follows = False
        self._begun: Chosen = []

    def _handle_events(self, events: Sequence[Event]) -> None:
        for event in events:
            if self._connection.deaf:
                self._report_lost_request(event.data)
            elif isinstance(event, Noise) and (self._malformed or self._text_follows):
                self._exchange(event.data, self._continued(event.data))
                self._last = []
            else:
                self._malformed = isinstance(event, Noise)
                request = self._request(event)
                command = request.command
                self._text_follows = command is not None and command.request_text is not None
                self._begun = self._choose(request)
                self._exchange(event.data, self._begun)

    def _request(self, event: Event) -> Request:
        at = self._clock() - self._began
        if isinstance(event, Frame):
            return Request(at, event.data, event.command, self._command(event))
        return Request(at, event.data, None, None)

    def _command(self, frame: Frame) -> Command | None:
        try:
            return frame.message.command
        except ProtocolError:
            # The frame has an illegal value, but its id still identifies the command.
            named = (one for one in self._codec.table.commands if one.id == frame.command)
            return next(named, None)

    def _choose(self, request: Request) -> Chosen:
        return [
            (one, self._context(one, request)) for one in self._choosers if one.chooses(request)
        ]

    def _continued(self, data: bytes) -> Chosen:
        """Return what is applied to the rest of malformed input, or to the text of a request."""
        rest = Request(self._clock() - self._began, data, None, None)
        continuing = (one for one, _ in self._begun if one.fault.continues)
        return [(one, self._context(one, rest)) for one in continuing]

    def _context(self, chooser: Chooser, request: Request) -> Context:
        return Context(request, chooser.random, self._connection, self._codec.table, self._replies)

    def _exchange(self, data: bytes, chosen: Chosen) -> None:
        """Pass a request to the other peer, and its reply to the host."""
        for chooser, context in chosen:
            if data:
                data = chooser.fault.change_request(data, context)
                self._report(chooser, context, 0)
        self._last = chosen
        reply = self._peer.receive(data) if data else b""
        self._plan_flush()
        self._send(reply, chosen)

    def _send(self, data: bytes, chosen: Chosen, *, late: bool = False) -> None:
        """Plan a reply; ``late``: the faults that need no reply were applied with the request."""
        if late and self._connection.deaf:
            self._report_lost_reply(data)
            return
        reply: Reply = (Piece(0.0, data),) if data else ()
        number = self._replies if data else None
        self._replies += bool(data)
        delay = 0.0
        for chooser, context in chosen:
            needs_no_reply = not chooser.fault.wants_reply
            if (late and needs_no_reply) or not (reply or needs_no_reply):
                continue
            size, context.delay, context.number = len(joined(reply)), 0.0, number
            try:
                reply = chooser.fault.change_reply(reply, context)
            finally:
                # A fault that disconnects is reported, too.
                self._report(chooser, context, len(joined(reply)) - size)
            delay += context.delay
        self._connection.put(reply, delay, number)
        # What is due now is sent before the next request of the same chunk is handled: a fault
        # that drops unsent replies must not depend on how the requests were cut.
        self._due += self._take_from_outlet()

    def _take(self) -> bytes:
        due, self._due = self._due + self._take_from_outlet(), b""
        return due

    def _take_from_outlet(self) -> bytes:
        outlet = self._connection.outlet
        data = outlet.take(self._clock())
        completed, outlet.completed = outlet.completed, []
        if self._on_reply is not None:
            for number in completed:
                self._on_reply(number)
        return data

    def _plan_flush(self) -> None:
        wait = self._peer.wait
        self._peer_due = None if wait is None else self._clock() + wait

    def _report(self, chooser: Chooser, context: Context, added: int) -> None:
        detail, moved = context.take_report()
        if detail and self._on_fault is not None:
            request, kind = context.request, chooser.fault.kind
            self._on_fault(AppliedFault(request.at, kind, request.name, detail, added + moved))

    def _report_lost_reply(self, data: bytes) -> None:
        if data and self._on_fault is not None:
            at, lost = self._clock() - self._began, f"{len(data)} bytes not sent"
            self._on_fault(AppliedFault(at, "deaf", "data from the arm", lost, -len(data)))

    def _report_lost_request(self, data: bytes) -> None:
        if self._on_fault is not None:
            at, lost = self._clock() - self._began, f"{len(data)} bytes not received"
            self._on_fault(AppliedFault(at, "deaf", "data from the host", lost, 0))
