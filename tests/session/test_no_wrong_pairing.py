"""The law of pairing: no reply goes to another request, even if replies are late, lost or cut.

It holds if each reply starts to arrive within the grace, and arrives once.
"""

from __future__ import annotations

from hypothesis import assume, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from cobotwire import codec as codecs
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import ReplyMatched, SessionEvent
from cobotwire.session.pending import GRACE_SECONDS
from session.one_caller import OneCaller
from session.transit import Reply, arrive, bytes_until

REFERENCE = codecs.load(TABLE, "reference")
TIMEOUT = 0.1


class Pairing(RuleBasedStateMachine):
    """An arm that puts another number into each reply, so that a wrong pairing shows."""

    @initialize(codec=st.sampled_from(["reference", "native"]))
    def begin(self, codec: codecs.CodecName) -> None:
        self.session = OneCaller(codecs.load(TABLE, codec))
        self.now = 0.0
        self.line: list[Reply] = []
        self.count = 0
        self.right = -1

    def _request(self, name: str, joint: int, delay: float, lost: bool) -> None:
        assume(self.session.free_at(name, joint, now=self.now) <= self.now)
        assert self.session.request(name, (joint,), self.now, TIMEOUT)
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
    def request(self, name: str, joint: int, delay: float, lost: bool) -> None:
        """Send a request that is not held; the arm replies late, or never."""
        self._request(name, joint, delay, lost)

    @precondition(lambda self: self.line)
    @rule(size=st.integers(1, 30), cut=st.sampled_from([False] * 9 + [True]))
    def receive(self, size: int, cut: bool) -> None:
        """Receive some bytes: a part of a reply, or the end of one and the start of the next."""
        received, _ = arrive(self.line, size, cut)
        self._judge(self.session.receive(received, self.now))

    @precondition(lambda self: self.session.waiting)
    @rule()
    def give_up(self) -> None:
        """Give up the request, as Ctrl-C does."""
        self.session.give_up()

    @rule(seconds=st.floats(0.001, 0.6), late=st.booleans())
    def time_passes(self, seconds: float, late: bool) -> None:
        """Let time pass. No reply starts after the grace; the client may wake late."""
        end = self.now + seconds
        for reply in self.line:
            self.now = max(self.now, min(reply.due, end))
            if reply.due <= end and reply.sent == 0:
                self.receive(bytes_until(self.line, reply), cut=False)
                break
        self.now = end
        if not late:
            self._judge(self.session.wake(self.now))

    def _judge(self, events: list[SessionEvent]) -> None:
        for event in events:
            if isinstance(event, ReplyMatched):
                number = event.fields.get("encoder", round(event.fields.get("angle", 0) * 10))
                assert number == self.right, "the reply to another request"

    @invariant()
    def outstanding_replies_are_bounded(self) -> None:
        """Check that there is at most one outstanding reply for each request."""
        if hasattr(self, "session"):
            assert len(self.session.exchange._outstanding.replies) <= self.count


TestPairing = Pairing.TestCase
TestPairing.settings = settings(max_examples=150, stateful_step_count=40, deadline=None)
