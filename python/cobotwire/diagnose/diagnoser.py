"""Diagnose noise: take the events of a framer, return its frames, and findings for its noise."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable
from dataclasses import replace
from typing import TypeVar

from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.diagnose import garbage
from cobotwire.diagnose.findings import Finding
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.registry import RECOGNISERS
from cobotwire.diagnose.residue import Residue, Verdict, Wait

Item = Frame | Finding
Kind = TypeVar("Kind", bound=Recogniser)

# A packet or text may continue after frames of at most this many bytes together: an acknowledgement
# and the longest reply, twice. After more bytes it is unlikely that the parts belong together.
REACH = 64


class Diagnoser:
    """Turns noise into findings. Frames pass through, so the items are in the order of the stream.

    Each byte of noise is in exactly one finding. The findings depend on the stream, on where the
    framer was flushed and on the requests passed to :meth:`sent`, but not on the chunks. Noise
    waits while more bytes could change its diagnosis, and so do the frames after it. At most a
    panic dump (8 KiB) waits, with 64 bytes of frames for each of its bytes; in practice far less.
    :meth:`flush` ends the waiting.
    """

    def __init__(self, codec: Codec, listening: Listening = "reply") -> None:
        self._recognisers = [recogniser(codec, listening) for recogniser in RECOGNISERS]
        self._residue = Residue()
        self._held: deque[Frame] = deque()
        self._gap = 0
        self._last: Finding | None = None
        self._in_text = False
        # The number of bytes at the start of the residue at which nothing can be recognised,
        # whichever bytes follow.
        self._plain = 0
        # Matches where something may be recognised in the residue.
        self._interesting = re.compile(b"|".join(each.starts for each in self._recognisers))
        self._by_first_byte = [self._starting_with(bytes([byte])) for byte in range(256)]

    def _starting_with(self, byte: bytes) -> tuple[Recogniser, ...]:
        return tuple(each for each in self._recognisers if re.match(each.starts, byte))

    def recogniser(self, kind: type[Kind]) -> Kind:
        """Return the recogniser of that type."""
        return next(each for each in self._recognisers if isinstance(each, kind))

    def sent(self, data: bytes) -> None:
        """Note a request that was sent, so that its echo is recognised."""
        for recogniser in self._recognisers:
            recogniser.sent(data)

    def feed(self, events: Iterable[Event]) -> list[Item]:
        """Take events of the framer, in order; return the frames and findings that are certain."""
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
        """Return findings for what waits for more bytes; call it after the framer's ``flush``."""
        items: list[Item] = []
        self._scan(items, closed=True)
        self._in_text = False
        return items

    def _scan(self, items: list[Item], closed: bool) -> None:
        residue = self._residue
        if not residue and not self._held:
            return
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
        self._last, self._in_text = finding, finding.readable
        for recogniser in self._recognisers:
            recogniser.found(finding)
        while self._held and self._held[0].offset < finding.offset:
            items.append(self._held.popleft())
        items.append(finding)

    def _continues(self, finding: Finding) -> bool:
        """Return whether this continues the previous finding, which was cut at its limit."""
        last = self._last
        if last is None or type(last) is not type(finding):
            return False
        end = last.spans[-1].offset + len(last.spans[-1].data)
        full = len(last.data) == last.piece and not last.data.endswith(b"\n")
        return full and end == finding.offset

    def _next(self, start: int) -> Finding | None:
        """Return the finding that starts at ``start``; None if more bytes are needed."""
        if not self._plain:
            verdict = self._recognise(start, self._in_text)
            if verdict is not None:
                return None if isinstance(verdict, Wait) else verdict
            self._plain = 1
        end, final = self._residue.segment_end(start)
        limit = min(end, start + garbage.PIECE_LIMIT)
        offset = start + self._plain
        while (offset := self._next_offset(offset, limit)) < limit:
            verdict = self._recognise(offset, after_text=False)
            if verdict is not None:
                self._plain = offset - start
                return None if isinstance(verdict, Wait) else self._unknown(start, offset)
            offset += 1
        self._plain = limit - start
        cut = self._plain == garbage.PIECE_LIMIT
        return self._unknown(start, limit) if cut or final else None

    def _next_offset(self, start: int, limit: int) -> int:
        """Return the first offset at which something may be recognised, or ``limit`` or more."""
        # The match may reach beyond the limit; the recogniser looks at all bytes.
        found = self._interesting.search(self._residue.data, start, limit)
        return found.start() if found else limit

    def _unknown(self, start: int, end: int) -> Finding:
        self._plain = 0
        return garbage.classify(self._residue.spans(start, end), self._residue.reason(start))

    def _recognise(self, at: int, after_text: bool) -> Verdict:
        residue = self._residue
        residue.after_text = after_text
        for recogniser in self._by_first_byte[residue.data[at]]:
            verdict = recogniser.recognise(residue, at)
            if verdict is not None:
                return verdict
        return None
