"""The law of pairing for callers that share a line.

Queries are repeated, one-way requests are acknowledged or not, calls are cancelled, and replies are
late, lost, cut or duplicated. No reply goes to another request if it starts to arrive within the
grace, and its second copy (if any) arrives before the next request is sent. A one-way request is
confirmed only by its own acknowledgement.

The law of deadlines: no caller waits longer than until its deadline. A request is not sent after
it, and the error says how often it was sent by then.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from cobotwire import ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import Exchange, Pending, PendingAck, PendingRequest, RetryPolicy
from cobotwire.session.pending import GRACE_SECONDS
from cobotwire.session.request import RequestEncoder
from session.one_caller import submit

REFERENCE = codecs.load(TABLE, "reference")
REQUESTS = ["get_encoder", "get_joint_min_angle", "get_angles_plan"]
ONE_WAY = ["set_color", "set_encoder"]
POLICY = RetryPolicy(attempts=3, shortest_attempt=0.05)
MOST = 1000
DEADLINES = st.sampled_from([inf, 0.1, 0.3, 1.5])


@dataclass
class Reply:
    """A reply in transit; it may be an acknowledgement, or a second copy.

    It starts to arrive by ``due``; ``sent`` bytes have arrived.
    """

    data: bytes
    due: float
    sent: int = 0
    acknowledges: Pending | None = None
    twice: bool = False

    @property
    def complete(self) -> bool:
        """Whether all bytes have arrived."""
        return self.sent == len(self.data)


@dataclass
class Known:
    """A call in progress: the numbers in replies to it, and whether it was acknowledged."""

    pending: Pending
    numbers: list[int] = field(default_factory=list)
    acknowledged: bool = False
    judged: bool = False


class Sharing(RuleBasedStateMachine):
    """An arm that puts another number into each reply, so that a wrong pairing shows."""

    @initialize(codec=st.sampled_from(["reference", "native"]))
    def begin(self, codec: codecs.CodecName) -> None:
        loaded = codecs.load(TABLE, codec)
        self.exchange = Exchange(loaded)
        self.encode = RequestEncoder(loaded).encode
        self.now = 0.0
        self.line: list[Reply] = []
        self.count = 0
        self.known: list[Known] = []

    @precondition(lambda self: len(self.exchange._queue) < 3)
    @rule(name=st.sampled_from(REQUESTS), joint=st.integers(1, 2), deadline=DEADLINES)
    def submit(self, name: str, joint: int, deadline: float) -> None:
        """Submit a request of another caller."""
        values = () if name == "get_angles_plan" else (joint,)
        request, ends_by = self.encode(name, values), self.now + deadline
        self.known.append(Known(submit(self.exchange, request, self.now, POLICY, 0.2, ends_by)))

    @rule(
        delay=st.floats(0.0, GRACE_SECONDS - 0.001),
        lost=st.sampled_from([False, False, True]),
        twice=st.sampled_from([False, False, False, True]),
    )
    def send(self, delay: float, lost: bool, twice: bool) -> None:
        """Send the next request; the line is drained, since every arrived byte was received."""
        if any(reply.twice and reply.sent for reply in self.line):
            return  # the second copy arrives before the next request is sent
        self.line = [reply for reply in self.line if not reply.twice]
        data = self.exchange.outgoing(self.now, drained=True)
        if not data:
            return
        pending = self.exchange.sent_last
        assert isinstance(pending, PendingRequest)
        assert self.now < pending.ends_by, "its caller may not wait any longer"
        known = next(known for known in self.known if known.pending is pending)
        self.count += 1
        number = self.count % MOST
        known.numbers.append(number)
        if lost:
            return
        reply = REFERENCE.encode(pending.request.command.name, "reply", _values(pending, number))
        self.line.append(Reply(reply, self.now + delay))
        if twice:
            self.line.append(Reply(reply, self.now + delay, twice=True))

    @rule(
        name=st.sampled_from(ONE_WAY),
        wait=st.sampled_from([None, 0.05, 0.9]),
        delay=st.floats(0.0, GRACE_SECONDS - 0.001),
        lost=st.sampled_from([False, True]),
        deadline=DEADLINES,
    )
    def one_way(
        self, name: str, wait: float | None, delay: float, lost: bool, deadline: float
    ) -> None:
        """Send a one-way request at once; the arm may acknowledge it."""
        request = self.encode(name, (1, 2, 3) if name == "set_color" else (1, 2000, 50))
        ends_by = self.now + deadline
        _, pending = self.exchange.send_one_way(request, self.now, wait, ends_by)
        if pending is not None:
            self.known.append(Known(pending))
        if not lost:
            ack = REFERENCE.encode(name, "reply", (1,))
            self.line.append(Reply(ack, self.now + delay, acknowledges=pending))

    @precondition(lambda self: self.line)
    @rule(size=st.integers(1, 40), cut=st.sampled_from([False] * 9 + [True]))
    def receive(self, size: int, cut: bool) -> None:
        """Receive some bytes: a part of a reply, or the end of one and the start of the next."""
        received, completed = arrive(self.line, size, cut)
        acknowledged = [reply.acknowledges for reply in completed]
        for known in self.known:
            known.acknowledged |= any(known.pending is pending for pending in acknowledged)
        self.exchange.receive(received, self.now)
        self._judge()

    @precondition(lambda self: any(not known.pending.done for known in self.known))
    @rule(which=st.integers(0, 9))
    def give_up(self, which: int) -> None:
        """Give up a request, as Ctrl-C or a cancelled task does."""
        waiting = [known for known in self.known if not known.pending.done]
        known = waiting[which % len(waiting)]
        known.judged = True
        self.exchange.give_up(known.pending)

    @rule(seconds=st.floats(0.001, 0.6), late=st.booleans())
    def time_passes(self, seconds: float, late: bool) -> None:
        """Let time pass. No reply starts after the grace; the client may wake late."""
        end = self.now + seconds
        for reply in list(self.line):
            if reply in self.line and reply.due <= end and reply.sent == 0:
                self.now = max(self.now, reply.due)
                self.receive(bytes_until(self.line, reply), cut=False)
        self.now = end
        if not late:
            self.exchange.advance(b"", self.now)
            waiting = [known.pending for known in self.known if not known.pending.done]
            assert all(pending.ends_by > self.now for pending in waiting), "it waits too long"
            self._judge()

    def _judge(self) -> None:
        for known in self.known:
            pending = known.pending
            if not pending.done or known.judged:
                continue
            known.judged = True
            error = pending._error
            if isinstance(error, ReplyTimeout) and error.waited_for:
                sent = len(known.numbers) if isinstance(pending, PendingRequest) else 1
                assert error.attempts == sent
                assert (error.waited_for == "reply") == bool(sent)
            if pending._error is None and isinstance(pending, PendingRequest):
                assert _number(pending) in known.numbers, "the reply to another request"
            elif pending._error is None and isinstance(pending, PendingAck):
                assert known.acknowledged, "the acknowledgement of another request"
        self.known = [known for known in self.known if not known.judged]

    @invariant()
    def waiting_call_has_a_time_to_wake(self) -> None:
        """Check that the exchange has a time to wake while a call waits, by each deadline."""
        ends = [known.pending.ends_by for known in self.known if not known.pending.done]
        if ends:
            idle = self.exchange.idle_seconds(self.now)
            assert idle is not None
            assert idle <= max(0.0, min(ends) - self.now)


def _values(pending: PendingRequest, number: int) -> list[object]:
    joint = pending.request.arguments.get("joint", 1)
    return {
        "get_encoder": [number],
        "get_joint_min_angle": [joint, number / 10],
        "get_angles_plan": [[number / 100, 0, 0, 0, 0, 0]],
    }[pending.request.command.name]


def _number(pending: PendingRequest) -> int:
    fields = pending.result()
    if "encoder" in fields:
        return int(fields["encoder"])
    scaled = fields["angle"] * 10 if "angle" in fields else fields["angles"][0] * 100
    number: int = round(scaled)
    return number


def arrive(line: list[Reply], size: int, cut: bool) -> tuple[bytes, list[Reply]]:
    """Take up to ``size`` bytes from the line; return them, and the replies that they complete.

    With ``cut``, the rest of each reply that they touch is lost.
    """
    received, completed = b"", []
    while line and len(received) < size:
        reply = line[0]
        part = reply.data[reply.sent :][: size - len(received)]
        reply.sent += len(part)
        received += part
        completed += [reply] if reply.complete else []
        if reply.complete or cut:
            line.pop(0)
    return received, completed


def bytes_until(line: list[Reply], reply: Reply) -> int:
    """Return how many bytes arrive up to the first byte of a reply: the line keeps the order."""
    before = line[: line.index(reply)]
    return sum(len(earlier.data) - earlier.sent for earlier in before) + 1


TestSharing = Sharing.TestCase
TestSharing.settings = settings(max_examples=120, stateful_step_count=50, deadline=None)
