"""The law of pairing, where many callers share the line: queries are asked again, orders are
acknowledged or not, calls are cancelled, replies are late, lost, cut, or come twice.

No answer goes to another question, as far as it has begun to come within the grace; a second copy,
as far as it comes before the next question goes out. No order counts as acknowledged unless it was.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import Conversation, Order, Question, RetryPolicy, Ticket
from cobotwire.session.policy import GRACE_SECONDS

REFERENCE = codecs.load(TABLE, "reference")
QUESTIONS = ["get_encoder", "get_joint_min_angle", "get_angles_plan"]
ORDERS = ["set_color", "set_encoder"]
POLICY = RetryPolicy(tries=3, shortest=0.05)
MOST = 1000


@dataclass
class Reply:
    """On its way: it begins to come at ``due``, or sooner; ``said`` bytes have come."""

    data: bytes
    due: float
    whose: Ticket | None
    said: int = 0
    twice: bool = False


@dataclass
class Known:
    """A call in course: the numbers that answers to it hold, and whether it was acknowledged."""

    ticket: Ticket
    numbers: list[int] = field(default_factory=list)
    acknowledged: bool = False
    told: bool = False


class Sharing(RuleBasedStateMachine):
    """An arm whose every answer holds another number, so that a wrong pairing shows."""

    @initialize(codec=st.sampled_from(["reference", "native"]))
    def begin(self, codec: codecs.CodecName) -> None:
        self.talk = Conversation(codecs.load(TABLE, codec))
        self.now = 0.0
        self.line: list[Reply] = []
        self.count = 0
        self.known: list[Known] = []

    @precondition(lambda self: len(self.talk._queue) < 3)
    @rule(name=st.sampled_from(QUESTIONS), joint=st.integers(1, 2))
    def ask(self, name: str, joint: int) -> None:
        """A caller queues a question."""
        values = () if name == "get_angles_plan" else (joint,)
        request = self.talk.prepare(name, values)
        self.known.append(Known(self.talk.ask(request, self.now, POLICY, 0.2)))

    @rule(
        delay=st.floats(0.0, GRACE_SECONDS - 0.001),
        lost=st.sampled_from([False, False, True]),
        twice=st.sampled_from([False, False, False, True]),
    )
    def send(self, delay: float, lost: bool, twice: bool) -> None:
        """The driver sends what is to be sent; the line is dry, as all that came was received."""
        if any(reply.twice and reply.said for reply in self.line):
            return  # the second copy comes before the next question goes out
        self.line = [reply for reply in self.line if not reply.twice]
        data = self.talk.outgoing(self.now, dry=True)
        if not data:
            return
        question = self.talk._asked
        assert isinstance(question, Question)
        known = next(known for known in self.known if known.ticket is question)
        self.count += 1
        number = self.count % MOST
        known.numbers.append(number)
        if lost:
            return
        reply = REFERENCE.encode(question.request.command.name, "reply", _values(question, number))
        self.line.append(Reply(reply, self.now + delay, None))
        if twice:
            self.line.append(Reply(reply, self.now + delay, None, twice=True))

    @rule(
        name=st.sampled_from(ORDERS),
        wait=st.sampled_from([None, 0.05, 0.9]),
        delay=st.floats(0.0, GRACE_SECONDS - 0.001),
        lost=st.sampled_from([False, True]),
    )
    def order(self, name: str, wait: float | None, delay: float, lost: bool) -> None:
        """An order goes out at once; the arm may acknowledge it."""
        request = self.talk.prepare(name, (1, 2, 3) if name == "set_color" else (1, 2000, 50))
        _, ticket = self.talk.order(request, self.now, wait)
        if ticket is not None:
            self.known.append(Known(ticket))
        if not lost:
            self.line.append(Reply(REFERENCE.encode(name, "reply", (1,)), self.now + delay, ticket))

    @precondition(lambda self: self.line)
    @rule(size=st.integers(1, 40), cut=st.sampled_from([False] * 9 + [True]))
    def hear(self, size: int, cut: bool) -> None:
        """Some bytes come: a part of an answer, or the end of one and the start of the next."""
        said = b""
        while self.line and len(said) < size:
            reply = self.line[0]
            part = reply.data[reply.said :][: size - len(said)]
            reply.said += len(part)
            said += part
            if reply.said == len(reply.data):
                for known in self.known:
                    known.acknowledged |= known.ticket is reply.whose
            if reply.said == len(reply.data) or cut:
                self.line.pop(0)
        self.talk.receive(said, self.now)
        self._judge()

    @precondition(lambda self: any(not known.ticket.done for known in self.known))
    @rule(which=st.integers(0, 9))
    def give_up(self, which: int) -> None:
        """Ctrl-C, or a task that is cancelled."""
        waiting = [known for known in self.known if not known.ticket.done]
        known = waiting[which % len(waiting)]
        known.told = True
        self.talk.give_up(known.ticket)

    @rule(seconds=st.floats(0.001, 0.6), late=st.booleans())
    def time_passes(self, seconds: float, late: bool) -> None:
        """No answer begins to come behind the grace. The driver may be late to wake."""
        end = self.now + seconds
        for reply in list(self.line):
            if reply in self.line and reply.due <= end and reply.said == 0:
                self.now = max(self.now, reply.due)
                before = self.line[: self.line.index(reply)]
                self.hear(sum(len(r.data) - r.said for r in before) + 1, cut=False)
        self.now = end
        if not late:
            self.talk.wake(self.now)
            self._judge()

    def _judge(self) -> None:
        for known in self.known:
            ticket = known.ticket
            if not ticket.done or known.told:
                continue
            known.told = True
            if ticket._error is None and isinstance(ticket, Question):
                assert _number(ticket) in known.numbers, "the answer to another question"
            elif ticket._error is None and isinstance(ticket, Order):
                assert known.acknowledged, "another order's acknowledgement"
        self.known = [known for known in self.known if not known.told]

    @invariant()
    def nobody_is_forgotten(self) -> None:
        """Whoever waits is in course, or there is a time at which something is done for it."""
        if hasattr(self, "talk") and any(not known.ticket.done for known in self.known):
            assert self.talk.wait(self.now) is not None


def _values(question: Question, number: int) -> list[object]:
    joint = question.request.asked.get("joint", 1)
    return {
        "get_encoder": [number],
        "get_joint_min_angle": [joint, number / 10],
        "get_angles_plan": [[number / 100, 0, 0, 0, 0, 0]],
    }[question.request.command.name]


def _number(question: Question) -> int:
    fields = question.result()
    if "encoder" in fields:
        return int(fields["encoder"])
    scaled = fields["angle"] * 10 if "angle" in fields else fields["angles"][0] * 100
    number: int = round(scaled)
    return number


TestSharing = Sharing.TestCase
TestSharing.settings = settings(max_examples=200, stateful_step_count=50, deadline=None)
