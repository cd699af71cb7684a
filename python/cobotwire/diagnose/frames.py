"""Recognise whole frames that the framer rejected: of the other direction, or unlisted."""

from __future__ import annotations

import re
from collections import deque
from dataclasses import dataclass
from typing import ClassVar

from cobotwire.codec.interface import Codec, Frame, Framer, Listening, NoiseReason
from cobotwire.diagnose.findings import Finding, Span
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.residue import Residue, Verdict, Wait
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.table import Direction

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
# The last requests are remembered, to recognise their echoes.
REMEMBERED = 8
_OTHER: dict[Listening, Direction] = {"request": "reply", "reply": "request"}


@dataclass(frozen=True, slots=True, kw_only=True)
class OppositeFrame(Finding):
    """A frame that is legal in the direction that the framer does not listen to.

    ``sent``: the bytes equal a request that was sent, so it is certainly an echo.
    """

    command: str
    direction: Direction
    sent: bool
    kind: ClassVar[str] = "opposite-frame"
    advice: ClassVar[str] = (
        "the line echoes what is sent, or another host uses it; replies are matched all the same, "
        "but turn the adapter's echo off if you can"
    )
    summary_noun: ClassVar[str] = "frame"

    def describe(self) -> str:
        """Describe the frame."""
        if self.sent:
            return f"echo of our request {self.command}"
        if self.direction == "request":
            return f"a request, {self.command}: an echo, or another host"
        return f"a reply, {self.command}"


@dataclass(frozen=True, slots=True, kw_only=True)
class UnlistedFrame(Finding):
    """A complete frame with an id that the edition lacks in the direction of the stream.

    ``command`` is the name of the id in the other direction; None if the edition lacks it there.
    """

    id: int
    command: str | None
    kind: ClassVar[str] = "unlisted-frame"
    advice: ClassVar[str] = "the firmware may use another edition: cobotwire identify URL finds out"
    summary_noun: ClassVar[str] = "frame"

    def describe(self) -> str:
        """Describe the frame."""
        name = self.command
        known = f"{name}, not listed in this direction" if name else "unknown"
        return f"a complete frame with the id 0x{self.id:02X} ({known})"


class FrameStarts(Recogniser):
    """The base of the recognisers of frames: finds header, LEN and id."""

    def __init__(self, codec: Codec, listening: Listening) -> None:
        self._format = codec.table.frame
        self._longest = self._format.overhead + self._format.maximum_length
        # Of commands that share an id, the first gives the name.
        self._names = {command.id: command.name for command in reversed(codec.table.commands)}
        self.starts = re.escape(self._format.header[:1])
        self._requests_only = listening == "request"

    def _id(self, head: bytes) -> int | None:
        """Return the id of a frame; None if it may be a reply, which carries none."""
        id = self._format.read_id(head)
        return id if self._format.reply_has_id or self._requests_only else None

    def _head(self, residue: Residue, at: int) -> tuple[bytes | None, int, bool]:
        """Return the bytes up to the id, the end of the segment, and whether that end is final.

        There are fewer bytes if the segment ends before the id, and None if no frame starts here.
        """
        limit, final = residue.segment_end(at)
        head = residue.data[at : min(limit, at + self._format.head_size)]
        fits = self._format.header.startswith(head[: len(self._format.header)])
        return head if fits else None, limit, final


class Frames(FrameStarts):
    """Recognises whole frames in the noise of one direction."""

    def __init__(self, codec: Codec, listening: Listening) -> None:
        super().__init__(codec, listening)
        self._indexes = {d: FrameIndex(codec.table, d) for d in DIRECTIONS}
        self._other = _OTHER.get(listening)
        # Framers are used, so that the law of framing is not repeated here.
        self._other_framer = None if self._other is None else codec.framer(self._other)
        self._any_framer = codec.framer(listening, accept_unknown=True)
        self._sent: deque[bytes] = deque(maxlen=REMEMBERED)

    def sent(self, data: bytes) -> None:
        """Note a request that was sent."""
        if data:
            self._sent.append(bytes(data))

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """Recognise the whole frame at ``at``."""
        head, limit, final = self._head(residue, at)
        echo = self._echo(residue, at, limit, final)
        if echo is not None or head is None:
            return echo
        if len(head) < self._format.head_size:
            return None if final else Wait.WAIT
        end = at + self._format.overhead + self._format.read_length(head)
        if not at + len(head) <= end <= at + self._longest:
            return None
        if end > limit:
            return None if final else Wait.WAIT
        return self._complete(residue, at, end)

    def _echo(self, residue: Residue, at: int, limit: int, final: bool) -> Verdict:
        waits = False
        for request in self._sent:
            here = residue.data[at : min(limit, at + len(request))]
            if here == request:
                return OppositeFrame(
                    spans=residue.spans(at, at + len(request)),
                    reason=residue.reason(at),
                    command=self._name(request, "request") or "unknown",
                    direction="request",
                    sent=True,
                )
            waits = waits or (not final and request.startswith(here))
        return Wait.WAIT if waits else None

    def _complete(self, residue: Residue, at: int, end: int) -> Finding | None:
        data, spans, reason = residue.data[at:end], residue.spans(at, end), residue.reason(at)
        if self._other_framer is not None and _is_frame(self._other_framer, data):
            return self.opposite(spans, reason)
        # In a direction without ids, every id counts as listed.
        id = self._format.read_id(data)
        if any(index.has(id) for d, index in self._indexes.items() if d != self._other):
            return None
        return self.unlisted(spans, reason) if _is_frame(self._any_framer, data) else None

    def opposite(self, spans: tuple[Span, ...], reason: NoiseReason) -> OppositeFrame:
        """Return the legal frame of the other direction that ``spans`` hold."""
        assert self._other is not None, "there is another direction"
        name = self._name(_joined(spans), self._other)
        assert name is not None, "the framer accepted its id"
        return OppositeFrame(
            spans=spans, reason=reason, command=name, direction=self._other, sent=False
        )

    def unlisted(self, spans: tuple[Span, ...], reason: NoiseReason) -> UnlistedFrame:
        """Return the frame with an unlisted id that ``spans`` hold."""
        id = self._format.read_id(_joined(spans))
        return UnlistedFrame(spans=spans, reason=reason, id=id, command=self._names.get(id))

    def _name(self, data: bytes, direction: Direction) -> str | None:
        """Return the name of the first command that has the id and the size of a frame."""
        if len(data) < self._format.head_size:
            return None
        length, id = len(data) - self._format.overhead, self._format.read_id(data)
        found = self._indexes[direction].find(id, length)
        return found[0].command.name if found else self._names.get(id)


def _is_frame(framer: Framer, data: bytes) -> bool:
    """Return whether ``data`` is exactly one frame."""
    events = [*framer.feed(data), *framer.flush()]
    return len(events) == 1 and isinstance(events[0], Frame)


def _joined(spans: tuple[Span, ...]) -> bytes:
    return b"".join(span.data for span in spans)
