"""The history of a run: what the simulated arm has received, and when it sent each reply."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from cobotwire.codec.interface import Codec, Noise
from cobotwire.conformance.report import Exchange
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command
from cobotwire.session.device import DeviceEvent, MalformedRequest, RequestReceived, TextReceived

# Test cases look back a few seconds; the line carries at most 678 requests a second.
REMEMBERED = 512
# Exchanges that a report shows as evidence.
SHOWN = 6


@dataclass(slots=True, eq=False)
class Received:
    """Something that the client sent; times are seconds since the run began.

    ``reply`` holds the bytes of the reply before any fault is applied. ``replied_at`` is when the
    last of them was sent; None: not yet, or they were lost.
    """

    at: float
    event: DeviceEvent
    reply: bytes = b""
    replied_at: float | None = None

    @property
    def data(self) -> bytes:
        """The bytes; empty for the text after a request: its bytes are an earlier noise event."""
        if isinstance(self.event, TextReceived):
            return b""
        return self.event.data if isinstance(self.event, Noise) else self.event.frame.data

    @property
    def noise(self) -> Noise | None:
        """The noise event, if the bytes are noise."""
        return self.event if isinstance(self.event, Noise) else None

    @property
    def error(self) -> ProtocolError | None:
        """The reason why the edition does not allow a frame; None: it is legal."""
        return self.event.error if isinstance(self.event, MalformedRequest) else None

    @property
    def is_frame(self) -> bool:
        """Whether it is a whole frame, with legal or illegal values."""
        return isinstance(self.event, RequestReceived | MalformedRequest)

    @property
    def command(self) -> Command | None:
        """The command of a legal request."""
        return self.event.message.command if isinstance(self.event, RequestReceived) else None

    @property
    def name(self) -> str:
        """The name of the command; empty if it is not a legal request."""
        return "" if self.command is None else self.command.name

    @property
    def awaits_reply(self) -> bool:
        """Whether the edition requires a reply."""
        return self.command is not None and self.command.requires_reply

    @property
    def changes_state(self) -> bool:
        """Whether it changes something, so that it must not be sent twice."""
        return self.command is not None and self.command.safety != "query"


@dataclass(slots=True)
class History:
    """Everything that was received.

    ``powered``: the arm has power. ``released``: it has power, but holds no joint. According to the
    field notes, a reply that has not come after ``patience`` seconds never comes.
    """

    codec: Codec
    patience: float = 0.03
    powered: bool = True
    released: bool = False
    entries: deque[Received] = field(default_factory=lambda: deque(maxlen=REMEMBERED))

    @property
    def last(self) -> Received | None:
        """What was received last."""
        return self.entries[-1] if self.entries else None

    def since(self, start: float) -> Iterator[Received]:
        """Yield what was received since ``start``, the newest first."""
        for entry in reversed(self.entries):
            if entry.at < start:
                return
            yield entry

    def outstanding(self, start: float) -> Iterator[Received]:
        """Yield the requests since ``start`` that still await their reply, the newest first."""
        return (e for e in self.since(start) if e.awaits_reply and e.replied_at is None)

    def unreplied(self, start: float, longest: float) -> Iterator[Received]:
        """Yield the outstanding requests since ``start`` that a client knows to be outstanding.

        A late reply to an equal request, sent up to ``longest`` seconds before, looks like the
        reply, so a client cannot know that its request is still outstanding.
        """
        replied = [e for e in self.since(start - longest) if e.replied_at is not None]
        for entry in self.outstanding(start):
            if not any(e.data == entry.data and (e.replied_at or 0) >= entry.at for e in replied):
                yield entry

    def missing_text(self) -> Received | None:
        """Return the newest request if its text has not come yet; else None."""
        for entry in reversed(self.entries):
            if isinstance(entry.event, TextReceived):
                return None
            if entry.command is not None:
                return entry if entry.command.request_text is not None else None
        return None

    def evidence(self, now: Received) -> tuple[Exchange, ...]:
        """Return the last exchanges in the order of their times."""
        exchanges: list[Exchange] = []
        for entry in [*list(self.entries)[1 - SHOWN :], now]:
            if entry.data:
                exchanges.append(Exchange(entry.at, "received", entry.data, _note(entry)))
            if entry.replied_at is not None:
                exchanges.append(Exchange(entry.replied_at, "sent", entry.reply))
        return tuple(sorted(exchanges, key=lambda exchange: exchange.at))


def _note(entry: Received) -> str:
    if entry.noise is not None:
        return entry.noise.reason
    return entry.name if entry.error is None else str(entry.error)
