"""What received bytes are, and how the request that waits ends by them or by silence."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from cobotwire.codec.interface import Codec, Event, Frame, Framer, Noise
from cobotwire.protocol.addresses import ANYBODY
from cobotwire.protocol.errors import ProtocolError
from cobotwire.session.acks import Acks
from cobotwire.session.echo import EchoDetector
from cobotwire.session.events import ReplyMatched, ReplyRejected, RequestExpired, SessionEvent
from cobotwire.session.matching import can_come_from, repeats_arguments, replies_elsewhere
from cobotwire.session.other_frames import OtherFrames
from cobotwire.session.outstanding import OutstandingReplies
from cobotwire.session.pending import PendingRequest
from cobotwire.session.turns import Turns


class Replies:
    """Matches received frames to the request that waits; :class:`OtherFrames` takes the others.

    Attributes:
        chunk_at: where in the stream the bytes began that were received last.
    """

    def __init__(
        self,
        codec: Codec,
        framer: Framer,
        turns: Turns,
        outstanding: OutstandingReplies,
        acks: Acks,
        echo: EchoDetector,
    ) -> None:
        self._codec, self._framer = codec, framer
        self._format = codec.table.frame
        self._turns, self._outstanding, self._echo = turns, outstanding, echo
        self._others = OtherFrames(codec.table, outstanding, acks, echo)
        self.chunk_at = 0

    def sort(self, received: Sequence[Event], now: float) -> list[SessionEvent]:
        """Return what the framer's events are."""
        return [
            self._take_noise(event, now) if isinstance(event, Noise) else self._match(event, now)
            for event in received
        ]

    def end(self, waiting: PendingRequest, fields: dict[str, Any], now: float) -> None:
        """End the request that waits with its reply."""
        if waiting.request.replier == ANYBODY:
            # Other devices may reply too.
            self._outstanding.expect_late(waiting, 0)
        elif len(waiting.attempt_times) > 1:
            self._outstanding.expect_late(waiting, 1)
        waiting.reply(fields, now)

    def end_wait(self, waiting: PendingRequest, now: float) -> list[SessionEvent]:
        """End the wait by silence after a text, by a copy that counts as reply, or by timeout."""
        request = waiting.request
        if waiting.text is not None and waiting.text.is_over(now):
            # What waits in the framer came after the text, and does not belong to it.
            try:
                fields = waiting.text.decode()
            except ProtocolError as error:
                waiting.fail(error)
                return [ReplyRejected(request.command, error)]
            waiting.reply(fields, now)
            return [ReplyMatched(request.command, fields, None)]
        # The framer gives up what waits in it, so that a frame hidden after it still counts.
        events = self.sort(self._framer.flush(), now)
        if waiting.done or now < waiting.ends_at:
            return events
        candidate = waiting.candidate
        if candidate is not None and not self._echo.proven:
            self.end(waiting, candidate.fields, now)
            return [*events, ReplyMatched(request.command, candidate.fields, candidate)]
        attempts, requested_at = len(waiting.attempt_times), waiting.requested_at
        self._outstanding.expect_late(waiting, 0)
        waiting.expire(self._codec, now - requested_at, attempts)
        return [*events, RequestExpired(request.command, requested_at, attempts)]

    def _take_noise(self, noise: Noise, now: float) -> Noise:
        self._others.take_noise(noise, self._turns.waiting(), now)
        return noise

    def _match(self, frame: Frame, now: float) -> SessionEvent:
        """Find out what a frame is; end the request that it replies to."""
        is_copy = self._echo.take_copy(frame)
        waiting = self._turns.last
        if waiting is None or waiting.done or not waiting.accepts(frame):
            return self._match_other(frame, self._turns.waiting(), now, is_copy)
        request = waiting.request
        if request.replier is not None:
            address = self._format.address(frame.data)
            if not can_come_from(address, request):
                return self._match_other(frame, waiting, now, is_copy)
        try:
            message = frame.decode("reply", of=request.command.name)
        except ProtocolError as error:
            if replies_elsewhere(frame, request.command, self._codec.table):
                return self._match_other(frame, waiting, now, is_copy)
            return self._others.reject(frame, error, waiting, is_copy)
        if is_copy:
            return self._others.weigh_copy(frame, message, waiting)
        if request.arguments and not repeats_arguments(message, request):
            return self._match_other(frame, waiting, now, is_copy)
        fields = message.fields
        self.end(waiting, fields, now)
        return ReplyMatched(request.command, fields, message, frame)

    def _match_other(
        self, frame: Frame, waiting: PendingRequest | None, now: float, is_copy: bool
    ) -> SessionEvent:
        began_at = now if frame.offset >= self.chunk_at else -inf
        return self._others.match(frame, waiting, now, began_at, is_copy)
