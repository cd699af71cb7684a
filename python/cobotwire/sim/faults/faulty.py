"""A peer between the host and another peer, that does faults."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cobotwire.codec.interface import Codec, Event, Frame, Noise
from cobotwire.errors import ProtocolError
from cobotwire.sim.faults.chooser import Chooser
from cobotwire.sim.faults.exchange import Done, Piece, Reply, Request, joined
from cobotwire.sim.faults.fault import Moment
from cobotwire.sim.faults.line import Line
from cobotwire.sim.peer import Peer
from cobotwire.table import Command

# A request that stands still this long is taken as it is.
IDLE_SECONDS = 0.2

Chosen = list[tuple[Chooser, Moment]]


class FaultyPeer:
    """Hears requests, lets the other peer answer, and says what a fault leaves of the answer.

    A peer for a pty, a socket or memory. What the other peer says later, by itself, counts as its
    reply to the request that it heard last.
    """

    def __init__(
        self,
        peer: Peer,
        codec: Codec,
        choosers: Sequence[Chooser],
        *,
        clock: Callable[[], float],
        watch: Callable[[Done], None] | None = None,
        restart: Callable[[], None] | None = None,
    ) -> None:
        """Stand in front of ``peer``; see :meth:`Scenario.wrap`, which makes one."""
        self._peer = peer
        self._codec = codec
        self._choosers = choosers
        self._clock = clock
        self._watch = watch
        self._line = Line(clock, restart or (lambda: None))
        self._began = clock()
        self._kept = b""
        self._last: Chosen = []
        # When the other peer wants to be woken.
        self._peer_due: float | None = None
        self._listen_anew()

    @property
    def wait(self) -> float | None:
        """In how many seconds :meth:`flush` must be called if nothing is heard; None: never."""
        times = [self._line.outlet.next, self._peer_due]
        if self._framer.pending:
            times.append(self._heard_at + IDLE_SECONDS)
        if self._kept:
            times.append(self._line.stopped_until)
        due = [time for time in times if time is not None]
        return max(0.0, min(due) - self._clock()) if due else None

    def receive(self, data: bytes) -> bytes:
        """Hear ``data``; gives what is said by now."""
        self._pass_time()
        if self._line.stopped:
            self._kept += data
        else:
            self._hear(data)
        return self._line.outlet.take(self._clock())

    def flush(self) -> bytes:
        """Time has passed; gives what is said by now."""
        self._pass_time()
        return self._line.outlet.take(self._clock())

    def power_cycle(self) -> None:
        """Switch the arm off and on: it hears again, and has lost its state."""
        self._kept = b""
        self._line.wake()
        self._listen_anew()

    def _pass_time(self) -> None:
        now = self._clock()
        if self._kept and not self._line.stopped:
            kept, self._kept = self._kept, b""
            self._hear(kept)
        if self._framer.pending and now >= self._heard_at + IDLE_SECONDS:
            self._sort(self._framer.flush())
            self._malformed = False
        if self._peer_due is not None and now >= self._peer_due:
            self._say(self._peer.flush(), self._last, alone=True)
            self._see_when_to_wake()

    def _hear(self, data: bytes) -> None:
        self._heard_at = self._clock()
        if self._line.deaf:
            self._miss(data)
            self._listen_anew()
            return
        self._sort(self._framer.feed(data))

    def _listen_anew(self) -> None:
        self._framer = self._codec.framer("request", accept_unknown=True)
        self._heard_at = self._clock()
        # Whether what came last was malformed: more of it is the same piece of it.
        self._malformed = False
        self._text_follows = False
        # What was chosen for the piece, or the request, that may go on.
        self._begun: Chosen = []

    def _sort(self, events: Sequence[Event]) -> None:
        for event in events:
            if self._line.deaf:
                self._miss(event.data)
            elif isinstance(event, Noise) and (self._malformed or self._text_follows):
                self._answer(event.data, self._going_on(event.data))
                self._last = []
            else:
                self._malformed = isinstance(event, Noise)
                request = self._request(event)
                command = request.command
                self._text_follows = command is not None and command.request_text is not None
                self._begun = self._chosen(request)
                self._answer(event.data, self._begun)

    def _request(self, event: Event) -> Request:
        at = self._clock() - self._began
        if isinstance(event, Frame):
            return Request(at, event.data, event.command, self._command(event))
        return Request(at, event.data, None, None)

    def _command(self, frame: Frame) -> Command | None:
        try:
            return frame.message.command
        except ProtocolError:
            # A value that the edition does not allow: its id still says what was meant.
            named = (one for one in self._codec.table.commands if one.id == frame.command)
            return next(named, None)

    def _chosen(self, request: Request) -> Chosen:
        frame = self._codec.table.frame
        chosen = [chooser for chooser in self._choosers if chooser.chooses(request)]
        return [(one, Moment(request, one.random, self._line, frame)) for one in chosen]

    def _going_on(self, data: bytes) -> Chosen:
        """What is done to the rest of malformed input, or to the text behind a request."""
        rest, frame = (
            Request(self._clock() - self._began, data, None, None),
            self._codec.table.frame,
        )
        going_on = (one for one, _ in self._begun if one.fault.goes_on)
        return [(one, Moment(rest, one.random, self._line, frame)) for one in going_on]

    def _answer(self, data: bytes, chosen: Chosen) -> None:
        for chooser, moment in chosen:
            if data:
                data = chooser.fault.hear(data, moment)
                self._tell(chooser, moment, 0)
        self._last = chosen
        said = self._peer.receive(data) if data else b""
        self._see_when_to_wake()
        self._say(said, chosen)

    def _say(self, said: bytes, chosen: Chosen, *, alone: bool = False) -> None:
        """Put the reply on the line; ``alone``: without what was done as the request was heard."""
        if alone and self._line.deaf:
            self._keep_quiet(said)
            return
        reply: Reply = (Piece(0.0, said),) if said else ()
        delay = 0.0
        for chooser, moment in chosen:
            done_as_heard = not chooser.fault.wants_reply
            if (alone and done_as_heard) or not (reply or done_as_heard):
                continue
            before, moment.delay = len(joined(reply)), 0.0
            try:
                reply = chooser.fault.say(reply, moment)
            finally:
                # A port that goes away is told too.
                self._tell(chooser, moment, len(joined(reply)) - before)
            delay += moment.delay
        self._line.put(reply, delay)

    def _see_when_to_wake(self) -> None:
        wait = self._peer.wait
        self._peer_due = None if wait is None else self._clock() + wait

    def _tell(self, chooser: Chooser, moment: Moment, more: int) -> None:
        detail, moved = moment.told()
        if detail and self._watch is not None:
            request = moment.request
            self._watch(Done(request.at, chooser.fault.kind, request.name, detail, more + moved))

    def _keep_quiet(self, said: bytes) -> None:
        if said and self._watch is not None:
            at, lost = self._clock() - self._began, f"{len(said)} bytes not said"
            self._watch(Done(at, "deaf", "what the arm says", lost, -len(said)))

    def _miss(self, data: bytes) -> None:
        if self._watch is not None:
            at = self._clock() - self._began
            self._watch(Done(at, "deaf", "what the host says", f"{len(data)} bytes not heard", 0))
