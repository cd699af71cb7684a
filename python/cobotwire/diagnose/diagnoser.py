"""Diagnosis of noise: events of a framer in, the same frames and findings out."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable
from dataclasses import replace

from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.diagnose import firmware, garbage
from cobotwire.diagnose.findings import (
    Boot,
    CommandError,
    Finding,
    Garbage,
    Nuls,
    Panic,
    ServoPacket,
    Text,
    Unrecognised,
)
from cobotwire.diagnose.frames import Frames
from cobotwire.diagnose.residue import Residue, Verdict, Wait
from cobotwire.diagnose.servo import ServoBus

Item = Frame | Finding

# A packet or text goes on behind frames of at most so many bytes together: a merged acknowledgement
# and the longest reply, twice. Behind more of them nobody could say what belongs together.
REACH = 64

_TEXTS = (Text, CommandError, Boot, Panic)
# Kinds that come in pieces, and how large the full ones are.
_PIECES: dict[type[Finding], int] = {
    Text: firmware.LINE_LIMIT,
    Nuls: garbage.NUL_LIMIT,
    Unrecognised: garbage.PIECE_LIMIT,
    Garbage: garbage.PIECE_LIMIT,
}


class Diagnoser:
    """Says what noise is. Frames pass through, so all comes in the order of the stream.

    Each byte of noise is in exactly one finding, and findings depend on the stream, on where the
    framer was flushed and on what was told to be sent, but not on chunks. What may still change
    waits, and so do the frames behind it: at most a panic dump (8 KiB) and 64 bytes of frames for
    each of its bytes, in practice far less. :meth:`flush` decides with what is there.
    """

    def __init__(self, codec: Codec, listening: Listening = "reply") -> None:
        self._frames = Frames(codec, listening)
        self._bus = ServoBus()
        self._residue = Residue()
        self._held: deque[Frame] = deque()
        self._gap = 0
        self._last: Finding | None = None
        self._in_text = False
        # So many bytes from the start of the residue are known to start nothing, whatever comes.
        self._plain = 0
        # Where, in bytes of the residue, something may be recognised.
        self._interesting = re.compile(
            re.escape(codec.table.frame.header[:1])
            + rb"|\xff(?:\xff|\Z)|\0{%d}|\0+\Z" % garbage.NUL_MINIMUM
            + rb"|[%s]{%d}|[%s]+\Z" % (firmware.READABLE, firmware.TEXT_MINIMUM, firmware.READABLE)
        )

    def sent(self, data: bytes) -> None:
        """Tell what goes out on this line: one request. Its echo is recognised as such."""
        self._frames.sent(data)

    def feed(self, events: Iterable[Event]) -> list[Item]:
        """Take events of one framer, in order; give frames and findings as far as is certain."""
        items: list[Item] = []
        for event in events:
            if isinstance(event, Noise):
                self._residue.add(event)
                self._gap = 0
                continue
            self._gap += len(event.data)
            far = self._gap > REACH
            if self._residue:
                self._residue.mark()
                self._scan(items, closed=far)
            self._in_text = self._in_text and not far
            if self._residue:
                self._held.append(event)
            else:
                items.append(event)
        self._scan(items, closed=False)
        return items

    def flush(self) -> list[Item]:
        """Decide what waits: nothing more comes, or not soon. To be called after the framer's."""
        items: list[Item] = []
        self._scan(items, closed=True)
        self._in_text = False
        return items

    def _scan(self, items: list[Item], closed: bool) -> None:
        residue = self._residue
        residue.join()
        residue.closed = closed
        at = 0
        while at < len(residue.data):
            finding = self._next(at)
            if finding is None:
                break
            at += sum(len(span.data) for span in finding.spans)
            self._emit(items, finding)
        residue.drop(at)
        residue.closed = False
        if not residue:
            items.extend(self._held)
            self._held.clear()

    def _emit(self, items: list[Item], finding: Finding) -> None:
        if self._continues(finding):
            finding = replace(finding, continued=True)
        self._last, self._in_text = finding, isinstance(finding, _TEXTS)
        if isinstance(finding, ServoPacket):
            self._bus.heard(finding)
        while self._held and self._held[0].offset < finding.offset:
            items.append(self._held.popleft())
        items.append(finding)

    def _continues(self, finding: Finding) -> bool:
        """Whether the finding before was cut at its limit, and this is the rest."""
        last = self._last
        if last is None or type(last) is not type(finding):
            return False
        end = last.spans[-1].offset + len(last.spans[-1].data)
        full = len(last.data) == _PIECES.get(type(last)) and not last.data.endswith(b"\n")
        return full and end == finding.offset

    def _next(self, start: int) -> Finding | None:
        """The finding that starts at ``start``; None if that cannot be told yet."""
        if not self._plain:
            verdict = self._recognise(start, self._in_text)
            if verdict is not None:
                return None if isinstance(verdict, Wait) else verdict
            self._plain = 1
        end, final = self._residue.stretch(start)
        limit = min(end, start + garbage.PIECE_LIMIT)
        place = start + self._plain
        while (place := self._place(place, limit)) < limit:
            verdict = self._recognise(place, in_text=False)
            if verdict is not None:
                self._plain = place - start
                return None if isinstance(verdict, Wait) else self._unknown(start, place)
            place += 1
        self._plain = limit - start
        cut = self._plain == garbage.PIECE_LIMIT
        return self._unknown(start, limit) if cut or final else None

    def _place(self, start: int, limit: int) -> int:
        """Where something may be recognised, from ``start`` on; ``limit`` or more: not before."""
        # The pattern also finds what the limit cuts; whoever recognises it sees the whole.
        found = self._interesting.search(self._residue.data, start, limit)
        return found.start() if found else limit

    def _unknown(self, start: int, end: int) -> Finding:
        self._plain = 0
        return garbage.classify(self._residue, start, end)

    def _recognise(self, at: int, in_text: bool) -> Verdict:
        residue, byte = self._residue, self._residue.data[at]
        verdict = self._frames.recognise(residue, at)
        if verdict is None and byte == 0xFF:
            verdict = self._bus.recognise(residue, at)
        if verdict is None and byte == 0:
            verdict = garbage.recognise_nuls(residue, at)
        return firmware.recognise(residue, at, in_text) if verdict is None else verdict
