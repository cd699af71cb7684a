"""Whose is a frame? By its id, by the arguments that it echoes, and by what may still come."""

from __future__ import annotations

from cobotwire.codec.interface import Codec, Frame, Message
from cobotwire.errors import ProtocolError
from cobotwire.session.acks import Acks
from cobotwire.session.debts import Debts
from cobotwire.session.echo import EchoWatch
from cobotwire.session.events import (
    Acknowledged,
    Answered,
    Echoed,
    Late,
    Refused,
    SessionEvent,
    Unasked,
)
from cobotwire.session.pending import Pending
from cobotwire.session.request import fits


class Matcher:
    """Knows what may come: late answers, acknowledgements, copies of what was sent."""

    def __init__(self, codec: Codec) -> None:
        self.debts = Debts(codec)
        self.acks = Acks(codec)
        self.echo = EchoWatch()
        self._codec = codec

    def match(self, frame: Frame, pending: Pending | None, now: float) -> SessionEvent:
        """What a frame is to the question that waits: Answered and Refused end it."""
        copy = self.echo.is_copy(frame)
        if (
            pending is None
            or frame.command != pending.command.id
            or not pending.command.reply
            # It had begun before the question was asked.
            or frame.offset < pending.since
        ):
            return self._other(frame, now, copy)
        try:
            message = self._codec.decode("reply", frame.data, of=pending.command.name)
        except ProtocolError as error:
            return self._refuse(pending, frame, copy, error)
        if copy:
            return self._weigh_copy(pending, frame, message)
        if not fits(message, pending.request):
            return self._other(frame, now, copy)
        return Answered(pending.command, message.fields, message, frame)

    def _other(self, frame: Frame, now: float, copy: bool) -> SessionEvent:
        """A frame that does not answer the question that waits."""
        owing = self.debts.settle(frame)
        if owing is not None and owing.command.answers:
            return Late(owing.command, frame)
        if copy:
            self.acks.note_copy(frame)
            return Echoed(frame)
        acknowledged = self.acks.match(frame, now)
        if acknowledged is None:
            return Unasked(frame)
        request, message = acknowledged
        return Acknowledged(request.command, message, frame)

    def _weigh_copy(self, pending: Pending, frame: Frame, message: Message) -> SessionEvent:
        """See :mod:`cobotwire.session.echo`."""
        if fits(message, pending.request):
            pending.candidate = message
        else:
            self.echo.proven = True
        return Echoed(frame)

    def _refuse(
        self, pending: Pending, frame: Frame, copy: bool, error: ProtocolError
    ) -> SessionEvent:
        """An answer that the edition rules out; unless it is no answer, or another question's."""
        if copy:
            self.echo.proven = True
            return Echoed(frame)
        if self.debts.any_of(frame.command):
            return Unasked(frame)
        return Refused(pending.command, error, frame)
