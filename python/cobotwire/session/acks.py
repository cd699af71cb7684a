"""Find out which of the one-way requests that were sent have been acknowledged.

An acknowledgement carries the command's id, perhaps a constant and arguments of the request. If
several requests with equal ids and arguments were sent and some acknowledgements are lost, it is
unknown which request each acknowledgement belongs to. So a request counts as acknowledged only when
the number of received acknowledgements exceeds the number that the other requests can still have
caused. An acknowledged request may seem unacknowledged. The reverse cannot happen, if each
acknowledgement comes once and in time. A lost acknowledgement causes doubt only until its time is
over.
"""

from __future__ import annotations

from collections import deque
from math import inf
from typing import NamedTuple

from cobotwire.codec.interface import Codec, DecodedMessage, Frame, Noise
from cobotwire.protocol.addresses import ANYBODY
from cobotwire.protocol.errors import LinkError, ProtocolError, RequestRefused
from cobotwire.session.events import FrameEvent
from cobotwire.session.matching import can_come_from, repeats_arguments, replies_differ
from cobotwire.session.pending import GRACE_SECONDS, Pending
from cobotwire.session.request import EncodedRequest, as_call

# Some firmware acknowledges a motion only when it ends.
MOTION_SECONDS = 60.0


class ExpectedAck:
    """An acknowledgement that may come, at ``offset`` of the stream or later.

    Attributes:
        request: the one-way request that was sent.
        sent_at: the second at which it was sent.
        until: the second after which it no longer counts.
        offset: where in the received stream it can begin at the earliest.
        doubts: for each similar acknowledgement of another request, the second until which it may
            come; soonest first.
        certain: whether it has certainly come: other requests cannot have caused all received
            acknowledgements.
    """

    __slots__ = ("certain", "doubts", "offset", "request", "sent_at", "until")

    def __init__(self, request: EncodedRequest, now: float, until: float, offset: int) -> None:
        self.request = request
        self.sent_at = now
        self.until = until
        self.offset = offset
        self.doubts: list[float] = []
        self.certain = False

    def doubt(self, until: list[float]) -> None:
        """Note until when similar acknowledgements of other requests may come."""
        self.doubts = sorted(until)

    def shorten(self, seconds: float) -> None:
        """Stop expecting the acknowledgement this many seconds after its request."""
        self.until = min(self.until, self.sent_at + seconds)

    def count(self, frame: Frame, began_at: float) -> None:
        """Count a similar acknowledgement; the first ones may belong to other requests."""
        self.doubts = [until for until in self.doubts if until > began_at]
        if self.doubts:
            if self.request.replier != ANYBODY:
                # After broadcasts, each other request may have several acknowledgements.
                self.doubts = self.doubts[1:]
        elif frame.offset >= self.offset:
            self.certain = True


class PendingAck(Pending):
    """A one-way request whose caller waits for its acknowledgement.

    Attributes:
        ack: the acknowledgement that is expected.
        until: when the wait ends.
    """

    __slots__ = ("ack", "until")

    def __init__(self, ack: ExpectedAck, until: float, ends_by: float) -> None:
        super().__init__(ack.request, ends_by)
        self.ack = ack
        self.until = until


class Acknowledged(NamedTuple):
    """An acknowledgement that came, and the oldest request that it can belong to."""

    request: EncodedRequest
    message: DecodedMessage


class _Received:
    """A frame that may be an acknowledgement, decoded once for each command."""

    def __init__(self, frame: Frame, address: int | None) -> None:
        self.frame = frame
        self._address = address
        self._messages: dict[str, DecodedMessage | None] = {}

    def of(self, request: EncodedRequest) -> DecodedMessage | None:
        """Return the frame as the acknowledgement of a request; None if it cannot be that."""
        if not can_come_from(self._address, request):
            return None
        name = request.command.name
        if name not in self._messages:
            try:
                self._messages[name] = self.frame.decode("reply", of=name)
            except ProtocolError:
                self._messages[name] = None
        message = self._messages[name]
        return message if message and repeats_arguments(message, request) else None


class _CommandAcks:
    """The requests of one command id, oldest first.

    Attributes:
        expected: those whose acknowledgement may still come, if each acknowledgement belongs to the
            oldest request.
        uncertain: those that a caller waits for and whose arrival is not certain.
        copied: the expected acknowledgement to a request of which a copy was received.
        began_at: since when acknowledgements have been expected without a break.
    """

    __slots__ = ("began_at", "copied", "expected", "uncertain")

    def __init__(self) -> None:
        self.expected: deque[ExpectedAck] = deque()
        self.uncertain: list[ExpectedAck] = []
        self.copied: ExpectedAck | None = None
        self.began_at = 0.0

    def add(self, ack: ExpectedAck, waited_for: bool) -> None:
        """Expect an acknowledgement, for which a caller may wait."""
        self.forget_expired(ack.sent_at)
        if not self.expected:
            self.began_at = ack.sent_at
        for earlier in self.uncertain:
            if not replies_differ(earlier.request, ack.request):
                earlier.doubt([*earlier.doubts, ack.until])
        if waited_for:
            ack.doubt(self.doubts_of(ack.request))
            self.uncertain.append(ack)
        self.expected.append(ack)

    def shorten(self, seconds: float, now: float) -> None:
        """Stop expecting each acknowledgement this many seconds after its request."""
        for ack in self.expected:
            ack.shorten(seconds)
        self.forget_expired(now)
        for ack in self.uncertain:
            ack.doubt(self.doubts_of(ack.request, ack))

    def note_copy(self, frame: Frame) -> None:
        """Note a copy of a request, if it is clear which of the expected ones was copied."""
        sent = [ack for ack in self.expected if ack.request.frame == frame.data]
        if len(sent) == 1 and not self.doubts_of(sent[0].request, sent[0]):
            self.copied = sent[0]

    def take(self, received: _Received, began_at: float) -> None:
        """Settle the oldest acknowledgement that a frame can be; count it for waiting callers."""
        settled = self.oldest(received)
        if settled is not None and settled.request.replier != ANYBODY:
            # Several devices may acknowledge a broadcast: it stays until its time is over.
            self.expected.remove(settled)
        for ack in self.uncertain:
            if received.of(ack.request):
                ack.count(received.frame, began_at)

    def doubts_of(self, request: EncodedRequest, ack: ExpectedAck | None = None) -> list[float]:
        """Return until when acknowledgements other than ``ack`` may seem to belong to a request."""
        others = (other for other in self.expected if other is not ack)
        return [each.until for each in others if not replies_differ(each.request, request)]

    def oldest(self, received: _Received) -> ExpectedAck | None:
        """Return the oldest acknowledgement that a frame can be, or None."""
        return next((ack for ack in self.expected if received.of(ack.request)), None)

    def forget_expired(self, now: float) -> None:
        while self.expected and self.expected[0].until <= now:
            self.expected.popleft()
        self.uncertain = [a for a in self.uncertain if a.until > now and not a.certain]


class Acks:
    """The acknowledgements of the requests that were sent lately, and the callers that wait.

    Attributes:
        waiting: what callers wait for; some may be done.
    """

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._format = codec.table.frame
        self._commands: dict[int, _CommandAcks] = {}
        self.waiting: list[PendingAck] = []
        # Whether this firmware was seen to acknowledge a motion at its start.
        # This is known from the start if another message reports the end of a motion.
        self._motions_at_once = codec.table.find_role("motion ended") is not None

    @property
    def next_end(self) -> float:
        """When the first wait ends; infinity if nobody waits."""
        return min((min(p.until, p.ends_by) for p in self.waiting if not p.done), default=inf)

    def expect(
        self,
        request: EncodedRequest,
        now: float,
        offset: int,
        within: float | None,
        ends_by: float = inf,
    ) -> tuple[ExpectedAck, PendingAck | None]:
        """Note that a request goes out; its acknowledgement can begin at ``offset``.

        The second result is None unless a caller waits for the acknowledgement: at most ``within``
        seconds, and not after ``ends_by``.
        """
        slow = request.command.safety == "motion" and not self._motions_at_once
        usual = MOTION_SECONDS if slow else GRACE_SECONDS
        ack = ExpectedAck(request, now, now + max(within or 0.0, usual), offset)
        acks = self._commands.setdefault(request.command.id, _CommandAcks())
        acks.add(ack, within is not None)
        if within is None:
            return ack, None
        pending = PendingAck(ack, now + within, ends_by)
        self.waiting.append(pending)
        return ack, pending

    def note_copy(self, frame: Frame) -> None:
        """Note a copy of a request, which is a bare acknowledgement unless the line echoes."""
        acks = self._commands.get(frame.command)
        if acks is not None:
            acks.note_copy(frame)

    def match(self, frame: Frame, now: float, began_at: float) -> Acknowledged | None:
        """Count a frame that is an acknowledgement; None: it is not one.

        ``began_at`` is when its first byte came; minus infinity if that is not known.
        """
        acks = self._commands.get(frame.command)
        if acks is None:
            return None
        acks.forget_expired(began_at)
        received = _Received(frame, self._format.address(frame.data))
        oldest = acks.oldest(received)
        message = None if oldest is None else received.of(oldest.request)
        if oldest is None or message is None or frame.offset < oldest.offset:
            return None
        self._learn(acks, received, now)
        # _learn may have shortened the wait for some acknowledgements, which then expired.
        acks.take(received, began_at)
        self._end_certain(message)
        return Acknowledged(oldest.request, message)

    def _learn(self, acks: _CommandAcks, received: _Received, now: float) -> None:
        """Learn whether motions are acknowledged at once.

        If only one motion is outstanding and its acknowledgement comes soon, they are. If several
        are outstanding, an early acknowledgement may belong to an older motion. But if
        acknowledgements have been outstanding without a break for longer than a motion may take, an
        older one was lost, and the early one belongs to the newest motion.
        """
        newest = next(ack for ack in reversed(acks.expected) if received.of(ack.request))
        if newest.request.command.safety != "motion" or now - newest.sent_at >= GRACE_SECONDS:
            return
        single = acks.began_at == newest.sent_at
        if single or now - acks.began_at > MOTION_SECONDS:
            self._motions_at_once = True
            acks.shorten(GRACE_SECONDS, now)

    def _end_certain(self, message: DecodedMessage) -> None:
        for pending in self.waiting:
            if pending.ack.certain and not pending.done:
                self._end(pending, message)
        self.drop_done()

    def _end(self, pending: PendingAck, message: DecodedMessage) -> None:
        """End a wait with its acknowledgement, which may say that the arm did not obey."""
        refusal = message.command.refusal(message.fields)
        if refusal is not None:
            call = as_call(pending.request, self._codec)
            pending.fail(RequestRefused(call, *refusal, pending.request.frame))
        else:
            pending.succeed({})

    def wake(self, now: float, echoes: bool) -> None:
        """End the waits whose time is over: a copy acknowledges, unless the line ``echoes``."""
        for pending in self.waiting:
            if pending.done:
                continue
            if pending.until <= now:
                copied = self._commands[pending.request.command.id].copied is pending.ack
                if copied and not echoes:
                    pending.succeed({})
                else:
                    pending.expire(self._codec, now - pending.ack.sent_at, 1)
            elif pending.ends_by <= now:
                pending.expire(self._codec, now - pending.ack.sent_at, 1, "reply")
        self.drop_done()

    def fail(self, error: LinkError) -> None:
        """End every wait: the transport is gone."""
        for pending in self.waiting:
            if not pending.done:
                pending.fail(error)
        self.drop_done()

    def note(self, event: FrameEvent | Noise) -> None:
        """Add an event to each waiting request, for the text of a timeout."""
        for pending in self.waiting:
            pending.note(event)

    def drop_done(self) -> None:
        """Forget the waits that have ended."""
        self.waiting = [pending for pending in self.waiting if not pending.done]
