"""Acknowledgements: which of the one-way requests that were sent has been acknowledged.

An acknowledgement carries only the command's id. Where several requests of one id were sent and
some acknowledgements are lost, it is unknown which request each belongs to. So a request counts
as acknowledged once more acknowledgements have come than the other requests can have caused. It may
seem unacknowledged although it was, never the reverse, if each acknowledgement comes once and in
time.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

from cobotwire.codec.interface import DecodedMessage, Frame
from cobotwire.protocol.errors import ProtocolError
from cobotwire.session.policy import GRACE_SECONDS
from cobotwire.session.request import EncodedRequest

# Some firmware acknowledges a motion only when it ends.
MOTION_SECONDS = 60.0


class ExpectedAck(NamedTuple):
    """An acknowledgement that may come, at ``offset`` of the stream or later.

    Attributes:
        request: the one-way request that was sent.
        until: the second after which it no longer counts.
        offset: where in the received stream it can begin at the earliest.
        balance: what the balance of its command must exceed for it to be certain.
    """

    request: EncodedRequest
    until: float
    offset: int
    balance: int


class _CommandAcks:
    """The requests of one command id; ``balance`` is acknowledgements less requests sent."""

    __slots__ = ("balance", "copied", "expected")

    def __init__(self) -> None:
        self.balance = 0
        # Those that may still come, oldest first.
        self.expected: deque[ExpectedAck] = deque()
        self.copied: ExpectedAck | None = None

    def forget_expired(self, now: float) -> None:
        while self.expected and self.expected[0].until <= now:
            self.expected.popleft()


class Acks:
    """Counts acknowledgements of the requests that were sent lately."""

    def __init__(self) -> None:
        self._commands: dict[int, _CommandAcks] = {}

    def expect(self, request: EncodedRequest, now: float, wait: float, offset: int) -> ExpectedAck:
        """Note that a request goes out; its acknowledgement can begin at ``offset``.

        It is expected for ``wait`` seconds at least.
        """
        usual = MOTION_SECONDS if request.command.safety == "motion" else GRACE_SECONDS
        acks = self._commands.get(request.command.id)
        if acks is None:
            acks = self._commands[request.command.id] = _CommandAcks()
        acks.forget_expired(now)
        balance = acks.balance + len(acks.expected) - 1
        ack = ExpectedAck(request, now + max(wait, usual), offset, balance)
        acks.expected.append(ack)
        acks.balance -= 1
        return ack

    def is_certain(self, ack: ExpectedAck) -> bool:
        """Return whether it has come, whichever requests the other ones belong to."""
        return self._commands[ack.request.command.id].balance > ack.balance

    def was_copied(self, ack: ExpectedAck) -> bool:
        """Return whether a copy of the request came: its acknowledgement, or its echo."""
        return self._commands[ack.request.command.id].copied is ack

    def note_copy(self, frame: Frame) -> None:
        """Note a copy of a request, which is a bare acknowledgement unless the line echoes."""
        acks = self._commands.get(frame.command)
        if acks is not None and len(acks.expected) == 1:
            [ack] = acks.expected
            if ack.request.frame == frame.data:
                acks.copied = ack

    def match(self, frame: Frame, now: float) -> tuple[EncodedRequest, DecodedMessage] | None:
        """Count a frame that is an acknowledgement; None: it is not one.

        Returns:
            The oldest request that it can belong to, and the decoded frame.
        """
        acks = self._commands.get(frame.command)
        if acks is None:
            return None
        acks.forget_expired(now)
        if not acks.expected or frame.offset < acks.expected[0].offset:
            return None
        request = acks.expected[0].request
        try:
            message = frame.decode("reply", of=request.command.name)
        except ProtocolError:
            return None
        acks.expected.popleft()
        acks.balance += 1
        return request, message
