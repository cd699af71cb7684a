"""Find out what received bytes are that do not simply reply to the request that waits.

They are late replies, acknowledgements, copies of requests, illegal replies, noise, or unexpected.
"""

from __future__ import annotations

from contextlib import suppress

from cobotwire.codec.interface import DecodedMessage, Frame, Noise
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.shared import once_per_table
from cobotwire.protocol.table import Command, Table
from cobotwire.session.acks import Acks
from cobotwire.session.echo import EchoDetector
from cobotwire.session.events import (
    AckReceived,
    EchoReceived,
    EventReceived,
    FrameEvent,
    LateReply,
    ReplyRejected,
    SessionEvent,
    UnexpectedFrame,
)
from cobotwire.session.matching import repeats_arguments
from cobotwire.session.outstanding import OutstandingReplies
from cobotwire.session.pending import PendingRequest


@once_per_table
def _events(table: Table) -> dict[int, list[Command]]:
    """Return the commands that are events, by id."""
    events: dict[int, list[Command]] = {}
    for command in table.commands:
        if command.event:
            events.setdefault(command.id, []).append(command)
    return events


class OtherFrames:
    """Matches frames to what may still come besides the reply, and notes all of them.

    In each method, ``waiting`` is the request that waits for its reply.
    """

    def __init__(
        self, table: Table, outstanding: OutstandingReplies, acks: Acks, echo: EchoDetector
    ) -> None:
        self._outstanding, self._acks, self._echo = outstanding, acks, echo
        self._events = _events(table)

    def take_noise(self, noise: Noise, waiting: PendingRequest | None, now: float) -> None:
        """Take noise, which may be the text that a request waits for."""
        self._echo.add_noise(noise)
        if waiting is not None and waiting.text is not None:
            # A text that began before the request was sent does not belong to it.
            waiting.text.add(noise.data[max(0, waiting.offset - noise.offset) :], now)
        self._note(noise, waiting)

    def match(
        self,
        frame: Frame,
        waiting: PendingRequest | None,
        now: float,
        began_at: float,
        is_copy: bool,
    ) -> SessionEvent:
        """Find out what a frame is that does not reply to the request that waits.

        Args:
            frame: the frame.
            waiting: the request that waits, if there is one.
            now: the time.
            began_at: when its first byte came, or earlier.
            is_copy: whether it repeats a request that was sent.
        """
        late = self._outstanding.find(frame, now)
        if late is not None:
            if late.request.command.requires_reply:
                # It stays outstanding: this may be a copy, with the reply itself still to come.
                return self._note(LateReply(late.request.command, frame), waiting)
            self._outstanding.settle(late)
        if is_copy:
            self._acks.note_copy(frame)
            return self._note(EchoReceived(frame), waiting)
        ack = self._acks.match(frame, now, began_at)
        if ack is None:
            return self._note(self._event(frame) or UnexpectedFrame(frame), waiting)
        return self._note(AckReceived(ack.request.command, ack.message, frame), waiting)

    def _event(self, frame: Frame) -> EventReceived | None:
        """Return a frame as an event that the device sends without a request; None: it is none."""
        for command in self._events.get(frame.command, ()):
            with suppress(ProtocolError):
                return EventReceived(command, frame.decode("reply", of=command.name), frame)
        return None

    def weigh_copy(
        self, frame: Frame, message: DecodedMessage, waiting: PendingRequest
    ) -> SessionEvent:
        """Keep a copy that can be the reply; one that cannot proves that the line echoes."""
        if repeats_arguments(message, waiting.request):
            waiting.keep_candidate(message)
        else:
            self._echo.prove()
        return self._note(EchoReceived(frame), waiting)

    def reject(
        self, frame: Frame, error: ProtocolError, waiting: PendingRequest, is_copy: bool
    ) -> SessionEvent:
        """End a request with a reply of illegal values, unless the frame is something else."""
        if is_copy:
            self._echo.prove()
            return self._note(EchoReceived(frame), waiting)
        if self._outstanding.has_command(frame):
            return self._note(UnexpectedFrame(frame), waiting)
        if len(waiting.attempt_times) > 1:
            self._outstanding.expect_late(waiting, 1)
        waiting.fail(error)
        return ReplyRejected(waiting.request.command, error, frame)

    def _note(self, event: FrameEvent | Noise, waiting: PendingRequest | None) -> SessionEvent:
        """Have everybody who waits remember an event, for the text of a timeout."""
        if waiting is not None:
            waiting.note(event)
        if self._acks.waiting:
            self._acks.note(event)
        return event
