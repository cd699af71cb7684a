"""One exchange with its callers, its line and its arm; each event is a method.

The world knows which request each reply belongs to; the exchange has to find this out. It reads and
writes as the clients do: ``cobotwire.client.steps``, ``cobotwire.client.writing``.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from cobotwire.codec.interface import Frame
from cobotwire.protocol.errors import LinkError
from cobotwire.session import Exchange, PendingRequest
from session.exploring import topics
from session.exploring.calls import Arrival, Call, Reply
from session.exploring.promises import Promises
from session.exploring.topics import CODEC, KINDS, POLICY, REPLIES, REQUESTS, TICK, WAIT

MOST_CALLS, MOST_REPLIES = 3, 3
# A reply comes no later than this: longer than any grace.
LATEST = 1.25


class World:
    """The state of everything that a promise depends on."""

    def __init__(self, topic: topics.Topic) -> None:
        self.topic = topic
        self.now = 0.0
        self.calls: list[Call] = []
        self.replies: list[Reply] = []
        self.unread: list[Arrival] = []
        self.next_write = "whole"
        # An arm may know more commands than the edition.
        self.arm = CODEC.framer("request", accept_unknown=True)
        # Which request begins at each offset of the bytes that the arm received.
        self.begun: dict[int, Call] = {}
        self.promises = Promises(self)
        self._open()

    def _open(self) -> None:
        self.exchange = Exchange(CODEC)
        self.fed = 0
        # The end of what was read, which the framer may not have parsed yet.
        self.tail = b""
        # By its first offset in the stream, each arrival that was read.
        self.arrivals: dict[int, Arrival] = {}

    @property
    def waiting(self) -> list[Call]:
        """The calls that have not ended."""
        return [call for call in self.calls if not call.ended]

    def choices(self) -> Iterator[topics.Event]:
        """Yield the events of the topic that can happen now."""
        if len(self.waiting) < MOST_CALLS and len(self.replies) < MOST_REPLIES:
            yield from (("call", kind) for kind in self.topic.kinds)
        for name in self.topic.events:
            if name in ("arrive", "arrive unread", "cut", "damaged"):
                for index, reply in enumerate(self.replies):
                    forms = len(REPLIES[reply.call.kind]) if name == "arrive" else 1
                    yield from ((name, str(index), str(form)) for form in range(forms))
            elif name == "give up":
                yield from ((name, str(index)) for index in range(len(self.waiting)))
            elif name != "write":
                yield (name,)
            elif self.next_write == "whole":
                yield from ((name, how) for how in self.topic.writes)

    def do(self, event: topics.Event) -> None:
        """Let an event happen, have the client do what it then does, check the promises."""
        name, *details = event
        getattr(self, "_on_" + name.replace(" ", "_"))(*details)
        settled = name not in ("arrive unread", "write", "babble")
        while settled and self._turn():
            pass
        oldest = self.now - LATEST
        self.replies = [r for r in self.replies if r.times < 2 and r.requested_at > oldest]
        self.promises.check(settled)

    def _on_call(self, kind: str) -> None:
        request, patience = REQUESTS[kind], KINDS[kind].patience
        call = Call(kind, inf if patience is None else self.now + patience)
        self.calls.append(call)
        if call.is_query:
            pending = PendingRequest(request, WAIT, POLICY, self.now, call.ends_by)
            call.pending = pending
            self.exchange.enqueue(pending)
            return
        data, call.pending = self.exchange.send_one_way(request, self.now, patience)
        call.ended = patience is None
        if not self._write(call, data):
            call.ended = True

    def _on_arrive(self, index: str, form: str) -> None:
        reply = self.replies[int(index)]
        reply.times += 1
        data = REPLIES[reply.call.kind][int(form)]
        self.unread.append(Arrival(data, self.now, reply, reply.times, int(form)))

    _on_arrive_unread = _on_arrive

    def _on_cut(self, index: str, form: str, size: int = 4, end: bytes = b"") -> None:
        self._on_arrive(index, form)
        last = self.unread[-1]
        last.data, last.form = last.data[:size] + end, -1

    def _on_damaged(self, index: str, form: str) -> None:
        self._on_cut(index, form, -1, b"\x00")

    def _on_event(self) -> None:
        self.unread.append(Arrival(topics.EVENT, self.now))

    def _on_pass(self) -> None:
        """Let time pass until the exchange has something to do."""
        idle = self.exchange.idle_seconds(self.now)
        self.now += POLICY.grace if idle is None else idle or TICK

    def _on_tick(self) -> None:
        self.now += min(TICK, self.exchange.idle_seconds(self.now) or TICK)

    def _on_babble(self) -> None:
        """Let time pass in which the line brings more than the client reads."""
        self._on_pass()
        unread, self.unread, before = self.unread, [Arrival(b"\x00", self.now)], self.now
        self._turn()
        if self.now > before:
            self._turn()  # after a slow write
        self.unread = unread + self.unread

    def _on_give_up(self, index: str) -> None:
        self._give_up(self.waiting[int(index)])

    def _give_up(self, call: Call) -> None:
        call.ended = True
        if call.pending is not None:
            self.exchange.give_up(call.pending)

    def _on_write(self, how: str) -> None:
        self.next_write = how

    def _on_lose(self) -> None:
        self.unread.clear()
        self.promises.lose()
        self.promises.note(self.exchange.fail(LinkError("port", "gone"), self.now))

    def _on_reopen(self) -> None:
        state = self.exchange.persist(self.now)
        self.promises.reopen()
        for call in self.waiting:
            call.ended = True
        self._open()
        self.exchange.restore(state)

    def _turn(self) -> bool:
        """Read once, let time pass, write the next request; return whether it did either."""
        exchange, data = self.exchange, b""
        arrivals, self.unread = self.unread, []
        for arrival in arrivals:
            self.arrivals[self.fed + len(data)] = arrival
            data += arrival.data
            self.promises.read(arrival)
        self.fed += len(data)
        self.tail = (self.tail + data)[-64:]
        self.promises.note(exchange.advance(data, self.now))
        request = b""
        if exchange.has_next(self.now):
            request = exchange.outgoing(self.now, drained=not data)
        if request:
            [call] = [call for call in self.calls if call.pending is exchange.sent_last]
            if not self._write(call, request):
                exchange.fail_waiting(LinkError("port", "the line is full"))
        return bool(data or request)

    def _write(self, call: Call, request: bytes) -> bool:
        """Write a request in the way chosen for the next write; return whether it was not cut."""
        self.promises.write(call)
        how, _, place = self.next_write.partition(" ")
        self.next_write = "whole"
        alignment, received = self.exchange.alignment, call.received_by_arm
        align = alignment.align
        data = align + request
        # A negative number counts from the end.
        taken = data[: int(place)] if place else data
        self.now += WAIT if how == "slow" else 0.0
        call.writes.append(self.now)
        self.begun[self.arm.fed + len(align)] = call
        for event in self.arm.feed(taken):
            if isinstance(event, Frame) and (owner := self.promises.obeyed(event)):
                owner.received_by_arm += 1
                self.replies.append(Reply(owner, self.now))
        if self.topic.echoes:
            self.unread += [Arrival(each, self.now) for each in (align, request) if each]
        if how == "cut":
            alignment.cut(align, request, len(taken))
            return False
        if how == "torn":
            alignment.cut(align, request, None)
            self.promises.lose()
            self._give_up(call)
            return True
        if align:
            alignment.end()
        if how == "slow" and isinstance(call.pending, PendingRequest):
            self.exchange.written(call.pending, self.now)
        if how == "lost":
            self._on_lose()
        else:
            self.promises.wrote(call, received)
        return True
