"""The law of pairing: whatever is late, lost or cut, no answer goes to another question.

Holds as far as an answer has begun to come within the grace, and comes once.
"""

from __future__ import annotations

from dataclasses import dataclass

from hypothesis import assume, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from cobotwire import codec as codecs
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import Answered, HostSession, SessionEvent
from cobotwire.session.policy import GRACE_SECONDS

REFERENCE = codecs.load(TABLE, "reference")
TIMEOUT = 0.1


@dataclass
class Reply:
    """On its way: it begins to come at ``due``, or sooner; ``said`` bytes have come."""

    data: bytes
    due: float
    said: int = 0


class Pairing(RuleBasedStateMachine):
    """An arm whose every answer holds another number, so that a wrong pairing shows."""

    @initialize(codec=st.sampled_from(["reference", "native"]))
    def begin(self, codec: codecs.CodecName) -> None:
        self.session = HostSession(codecs.load(TABLE, codec))
        self.now = 0.0
        self.line: list[Reply] = []
        self.count = 0
        self.right = -1

    def _asked(self, name: str, joint: int, delay: float, lost: bool) -> None:
        request = self.session.prepare(name, (joint,))
        held = self.session.hold_until(request)
        assume(held is None or held <= self.now)
        self.session.send(request, self.now, TIMEOUT)
        self.count += 1
        self.right = self.count % 1000
        if lost:
            return
        value = [self.right] if name == "get_encoder" else [joint, self.right / 10]
        data = REFERENCE.encode(name, "reply", value)
        self.line.append(Reply(data, self.now + delay))

    @precondition(lambda self: not self.session.waiting)
    @rule(
        name=st.sampled_from(["get_encoder", "get_joint_min_angle", "get_joint_max_angle"]),
        joint=st.integers(1, 3),
        delay=st.floats(0.0, GRACE_SECONDS - 0.001),
        lost=st.sampled_from([False, False, False, True]),
    )
    def ask(self, name: str, joint: int, delay: float, lost: bool) -> None:
        """A question that is not held is asked; the arm answers late, or never."""
        self._asked(name, joint, delay, lost)

    @precondition(lambda self: self.line)
    @rule(size=st.integers(1, 30), cut=st.sampled_from([False] * 9 + [True]))
    def hear(self, size: int, cut: bool) -> None:
        """Some bytes come: a part of an answer, or the end of one and the start of the next."""
        said = b""
        while self.line and len(said) < size:
            reply = self.line[0]
            part = reply.data[reply.said :][: size - len(said)]
            reply.said += len(part)
            said += part
            if reply.said == len(reply.data) or cut:
                self.line.pop(0)
        self._judge(self.session.receive(said, self.now))

    @precondition(lambda self: self.session.waiting)
    @rule()
    def give_up(self) -> None:
        """Ctrl-C."""
        self.session.abandon()

    @rule(seconds=st.floats(0.001, 0.6), late=st.booleans())
    def time_passes(self, seconds: float, late: bool) -> None:
        """No answer begins to come behind the grace. The driver may be late to wake."""
        end = self.now + seconds
        for reply in self.line:
            self.now = max(self.now, min(reply.due, end))
            if reply.due <= end and reply.said == 0:
                # The line keeps the order: what was said before comes first.
                self.hear(
                    sum(len(r.data) - r.said for r in self.line[: self.line.index(reply)]) + 1,
                    cut=False,
                )
                break
        self.now = end
        if not late:
            self._judge(self.session.wake(self.now))

    def _judge(self, events: list[SessionEvent]) -> None:
        for event in events:
            if isinstance(event, Answered):
                number = event.fields.get("encoder", round(event.fields.get("angle", 0) * 10))
                assert number == self.right, "the answer to another question"

    @invariant()
    def what_is_remembered_is_bounded(self) -> None:
        """At most one debt for each question of the last grace."""
        if hasattr(self, "session"):
            assert len(self.session._debts._debts) <= self.count


TestPairing = Pairing.TestCase
TestPairing.settings = settings(max_examples=150, stateful_step_count=40, deadline=None)
