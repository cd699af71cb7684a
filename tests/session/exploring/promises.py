"""What the exchange promises, as checks of a world, and the limits that the protocol sets."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from cobotwire.codec.interface import Frame
from cobotwire.protocol.errors import ReplyTimeout
from cobotwire.session.events import EchoReceived, ReplyMatched, ReplyRejected, SessionEvent
from cobotwire.session.pending import GRACE_SECONDS
from session.exploring.calls import Arrival, Call
from session.exploring.topics import POLICY, REPLIES, REQUESTS, WAIT

if TYPE_CHECKING:
    from session.exploring.world import World

# The limits of the protocol. Only these excuse a broken promise: the bytes show no difference.
LIMITS = {
    "later than its grace": "a reply does not say which request it belongs to",
    "second copy": "the second copy of a reply that was taken looks like the next reply",
    "pieces of cut replies": "without a check, several pieces can be a legal reply together",
    "acknowledged before reopening": "an acknowledgement does not say which session it belongs to",
    "first copy on a line that echoes": "the echo of some requests is a legal reply to them",
    "torn around a whole frame": "nobody knows how much was written, and the inner frame is legal",
}
SILENCE = 0.2


class Broken(AssertionError):
    """A promise that does not hold."""


class Promises:
    """Checks the promises; ``limits`` counts how often each limit was met."""

    def __init__(self, world: World) -> None:
        self._world = world
        self.limits: Counter[str] = Counter()
        # The known limit: an acknowledgement of a command may belong to another request.
        self.doubtful: dict[str, str] = {}
        # Whether an echo was read that cannot be a reply.
        self.echo_shown = False
        # The offsets of requests that the arm may have received only in part.
        self.torn: set[int] = set()
        self._copy_at = 0

    def check(self, settled: bool) -> None:
        """Check every call; ``settled``: the client can do nothing more at this time."""
        world = self._world
        self.note(())
        idle = world.exchange.idle_seconds(world.now)
        for call in world.waiting:
            ends_by = call.ends_by
            if call.is_query and call.writes:
                silence = SILENCE if call.kind == "text" else 0.0
                ends_by = min(ends_by, call.writes[0] + WAIT + silence)
            if world.now >= ends_by:
                raise Broken(f"{call.kind} waits after its deadline")
            if idle is None or idle > ends_by - world.now:
                raise Broken(f"{call.kind} waits, and the client has no time to wake")
        queries = [call for call in world.waiting if call.is_query]
        if settled and not any(call.writes for call in queries):
            for call in queries:
                if not any(self._may_be_late(other, call) for other in world.calls):
                    raise Broken(f"{call.kind} is held without a late reply that may still come")

    def _may_be_late(self, other: Call, call: Call) -> bool:
        """Return whether a late reply to another request may look like the reply to a call."""
        alike = other.command == call.command and (
            other.kind == call.kind or "pin" not in call.kind
        )
        answered = other.answered and len(other.writes) == 1
        until = other.writes[-1] + POLICY.grace if other.writes else 0.0
        return alike and not answered and self._world.now < until

    def _check_end(self, call: Call) -> None:
        error = None if call.pending is None else call.pending._error
        if isinstance(error, ReplyTimeout):
            if error.attempts != len(call.writes):
                raise Broken(f"{call.kind} was sent {len(call.writes)} times, not {error.attempts}")
            if self._must_succeed(call):
                raise Broken(f"{call.kind} timed out, although its reply came in time")
        if error is None and call.is_query and not call.answered:
            raise Broken(f"{call.kind} is settled by nothing that was reported as its reply")
        if error is None and not call.is_query and not call.read:
            limit = self.doubtful.get(call.command) or self._echo_limit(call, call.ends_by)
            self._excuse(limit, f"{call.kind} is not acknowledged")

    def _must_succeed(self, call: Call) -> bool:
        """Return whether the bytes that were read while a call waited can only be its reply."""
        world, frame = self._world, REQUESTS[call.kind].frame
        at_deadline = call.writes and world.now >= call.writes[0] + WAIT
        # A frame may be hidden after one that was cut, until the deadline of a query.
        hidden = bool(world.exchange._framer.pending) and not (call.is_query and at_deadline)
        certain = not hidden and any(REPLIES[call.kind][form] != frame for form in call.read)
        if call.is_query:
            copy_counts = call.read and at_deadline and not world.topic.echoes
            # A doubled text is another text.
            return call.kind != "text" and bool(certain or copy_counts)
        return certain and [c.command for c in world.calls].count(call.command) == 1

    def reopen(self) -> None:
        """Note that another session follows."""
        one_way = [call.command for call in self._world.calls if not call.is_query]
        self.doubtful.update(dict.fromkeys(one_way, "acknowledged before reopening"))

    def read(self, arrival: Arrival) -> None:
        """Note what the client reads now."""
        if arrival.reply is None:
            self.echo_shown |= self._world.topic.echoes and not any(
                arrival.data in replies for replies in REPLIES.values()
            )
            return
        call = arrival.reply.call
        for waiting in self._world.waiting:
            if call.kind == waiting.kind == "text" and waiting.writes:
                waiting.texts.append(arrival)
        if arrival.form >= 0:
            if call.waits:
                call.read.add(arrival.form)
            if not call.is_query and (limit := self._limit(arrival, GRACE_SECONDS)):
                self.doubtful[call.command] = limit

    def note(self, events: Iterable[SessionEvent]) -> None:
        """Check which arrivals have settled requests, and how calls have ended."""
        last = self._world.exchange.sent_last
        for event in events:
            joined = self._joined(event)
            if isinstance(event, EchoReceived) and last and event.frame.data == last.request.frame:
                self._copy_at = event.frame.offset
            elif isinstance(event, ReplyMatched | ReplyRejected):
                [call] = [call for call in self._world.calls if call.pending is last]
                call.answered = True
                offset = self._copy_at if event.frame is None else event.frame.offset
                for arrival in call.texts or joined or [self._world.arrivals[offset]]:
                    self._check_pair(call, arrival, "pieces of cut replies" if joined else None)
        for call in self._world.waiting:
            if not call.waits:
                call.ended = True
                self._check_end(call)

    def _joined(self, event: SessionEvent) -> list[Arrival]:
        """Return the arrivals inside a frame, which then began with a piece of a cut reply."""
        frame: Frame | None = getattr(event, "frame", None)
        if frame is None:
            return []
        inside = range(frame.offset + 1, frame.offset + len(frame.data))
        joined = [arrival for at, arrival in self._world.arrivals.items() if at in inside]
        for arrival in joined:
            if arrival.reply is not None:
                arrival.reply.call.read.discard(arrival.form)
        return joined

    def _check_pair(self, call: Call, arrival: Arrival, limit: str | None) -> None:
        owner = None if arrival.reply is None else arrival.reply.call
        if owner is call and limit is None:
            return
        # A damaged text is still a text.
        if limit is None and (arrival.data in REPLIES[call.kind] or call.kind == "text"):
            deadline = call.writes[0] + WAIT
            limit = self._limit(arrival, POLICY.grace) or self._echo_limit(call, deadline)
        call.misled = limit
        other = "an echo or event" if owner is None else f"the reply to an earlier {owner.kind}"
        self._excuse(limit, f"{call.kind} is settled by {other}")

    def _limit(self, arrival: Arrival, grace: float) -> str | None:
        """Return the limit that makes an arrival look like the reply to another request."""
        if arrival.reply is None:
            return None
        if arrival.time >= arrival.reply.requested_at + grace:
            return "later than its grace"
        call = arrival.reply.call
        # After any other end, the exchange expects late replies.
        expected = call.is_query and not (call.answered and len(call.writes) == 1)
        return "second copy" if arrival.copy > 1 and not expected else call.misled

    def _echo_limit(self, call: Call, deadline: float) -> str | None:
        """Return the known limit by which the echo of a request counts as its reply; None if
        there is no limit."""
        looks_alike = REQUESTS[call.kind].frame in REPLIES[call.kind]
        unknown = self._world.topic.echoes and not self.echo_shown
        counts = looks_alike and unknown and self._world.now >= deadline
        return "first copy on a line that echoes" if counts else None

    def _excuse(self, limit: str | None, why: str) -> None:
        if limit is None:
            raise Broken(why)
        assert limit in LIMITS
        self.limits[limit] += 1

    def write(self, call: Call) -> None:
        """Check that a request may be written now."""
        most = POLICY.attempts if REQUESTS[call.kind].command.safety == "query" else 1
        if len(call.writes) >= most:
            raise Broken(f"{call.kind} is sent more than {most} times")
        if call.is_query and (call.ended or self._world.now >= call.ends_by):
            raise Broken(f"{call.kind} is sent after its caller stopped waiting")

    def wrote(self, call: Call, received: int) -> None:
        """Check that the arm has received the whole request that was just written."""
        if call.received_by_arm == received:
            raise Broken(f"the arm did not receive {call.kind}, which was written whole")

    def lose(self) -> None:
        """Note that the arm may have received any part of the requests that are not yet read."""
        begun = self._world.begun.items()
        self.torn |= {at for at, call in begun if call.received_by_arm < len(call.writes)}

    def obeyed(self, frame: Frame) -> Call | None:
        """Return the request that the arm has received, if a caller sent it."""
        begun = self._world.begun
        call = begun.get(frame.offset)
        if call is not None and frame.data == REQUESTS[call.kind].frame:
            return call
        ends = ((at, at + len(REQUESTS[begun[at].kind].frame)) for at in self.torn)
        inside = any(start < frame.offset < end for start, end in ends)
        limit = "torn around a whole frame" if inside else None
        self._excuse(limit, f"the arm received {frame.data.hex(' ')}, which nobody sent")
        return None
