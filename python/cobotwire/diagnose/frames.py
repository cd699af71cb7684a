"""Recognise frames that the framer rejected: of the other direction, unlisted, or damaged."""

from __future__ import annotations

from collections import deque

from cobotwire.codec.interface import Codec, Frame, Listening
from cobotwire.diagnose import firmware, servo
from cobotwire.diagnose.findings import DamagedFrame, Finding, OppositeFrame, UnlistedFrame
from cobotwire.diagnose.residue import Residue, Verdict, Wait
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.table import Direction

_DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
# The last requests are remembered, to recognise their echoes.
REMEMBERED = 8
# A damaged frame may have a few bytes more or less than an undamaged one; nearest first.
_SLACK = (0, -1, 1, -2, 2)
_DAMAGES = ("bad-length", "bad-check", "truncated")
_OTHER: dict[Listening, Direction] = {"request": "reply", "reply": "request"}


class Frames:
    """Recognises what starts like a frame of the edition, in the noise of one direction."""

    def __init__(self, codec: Codec, listening: Listening) -> None:
        self._format = codec.table.frame
        self._longest = self._format.overhead + self._format.maximum_length
        self._indexes = {d: FrameIndex(codec.table, d) for d in _DIRECTIONS}
        # Of commands that share an id, the first gives the name.
        self._names = {command.id: command.name for command in reversed(codec.table.commands)}
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
        """Recognise the frame, or what is left of one, at ``at``."""
        limit, final = residue.stretch(at)
        echo = self._echo(residue, at, limit, final)
        if echo is not None:
            return echo
        header = self._format.header
        head = residue.data[at : min(limit, at + self._format.overhead + 1)]
        if not head.startswith(header[: len(head)]):
            return None
        if len(head) <= self._format.overhead:
            return self._start_only(residue, at, limit) if final else Wait.WAIT
        end = at + self._format.overhead + head[self._format.length_at]
        if at + len(head) <= end <= at + self._longest:
            if end > limit and not final:
                return Wait.WAIT
            complete = self._complete(residue, at, end) if end <= limit else None
            if complete is not None:
                return complete
        return self._damaged(residue, at)

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

    def _start_only(self, residue: Residue, at: int, limit: int) -> Finding | None:
        """Return the start of a frame that is cut before its id."""
        if residue.reason(at) != "truncated":
            return None
        spans = residue.spans(at, limit)
        return DamagedFrame(spans=spans, reason="truncated", command=None, id=None)

    def _complete(self, residue: Residue, at: int, end: int) -> Finding | None:
        data, spans, reason = residue.data[at:end], residue.spans(at, end), residue.reason(at)
        id = data[self._format.overhead]
        if self._other is not None and self._other_framer is not None:
            events = [*self._other_framer.feed(data), *self._other_framer.flush()]
            if len(events) == 1 and isinstance(events[0], Frame):
                name = self._name(data, self._other)
                assert name is not None, "the framer accepted its id"
                return OppositeFrame(
                    spans=spans,
                    reason=reason,
                    command=name,
                    direction=self._other,
                    sent=False,
                )
        if any(index.has(id) for d, index in self._indexes.items() if d != self._other):
            return None
        events = [*self._any_framer.feed(data), *self._any_framer.flush()]
        if len(events) != 1 or not isinstance(events[0], Frame):
            return None
        return UnlistedFrame(spans=spans, reason=reason, id=id, command=self._names.get(id))

    def _name(self, data: bytes, direction: Direction) -> str | None:
        """Return the name of a frame's command; of those with its id, the first with its size."""
        length = len(data) - self._format.overhead
        if length <= 0:
            return None
        id = data[self._format.overhead]
        found = self._indexes[direction].find(id, length)
        return found[0].command.name if found else self._names.get(id)

    def _damaged(self, residue: Residue, at: int) -> Verdict:
        id, reason = residue.data[at + self._format.overhead], residue.reason(at)
        if reason not in _DAMAGES or id not in self._names:
            return None
        extent = self._extent(residue, at, id)
        if isinstance(extent, Wait):
            return extent
        spans = residue.spans(at, extent)
        return DamagedFrame(spans=spans, reason=reason, command=self._names[id], id=id)

    def _extent(self, residue: Residue, at: int, id: int) -> int | Wait:
        """Return the end of the damaged frame: after a footer near a legal end, or else by LEN.

        A byte may have been inserted or lost, so the footer is also searched after the end. A
        frame, a servo packet or a firmware message that starts inside ends the damaged frame.
        """
        limit, final = residue.stretch(at)
        reach = at + self._longest + max(_SLACK)
        if limit < reach and not final:
            return Wait.WAIT
        limit = min(limit, reach)
        for inside in range(at + 1, limit):
            stops = self._stops(residue, inside)
            if isinstance(stops, Wait):
                return stops
            if stops:
                limit = inside
                break
        format = self._format
        lengths = {length for index in self._indexes.values() for length in index.lengths_of(id)}
        claimed = residue.data[at + format.length_at]
        for length in sorted(lengths, key=lambda length: (length != claimed, length)):
            for extra in _SLACK if format.check == "footer" else ():
                end = at + format.overhead + length + extra
                if end <= limit and residue.data.startswith(format.footer, end - format.check_size):
                    return end
        return min(limit, at + format.overhead + (claimed if claimed in lengths else max(lengths)))

    def _stops(self, residue: Residue, at: int) -> bool | Wait:
        """Return whether something else starts at ``at``, inside a damaged frame."""
        data = residue.data
        packet = servo.size_of(data[at : at + servo.LONGEST])
        message = _starts_message(data[at : at + len(firmware.PANIC)])
        if packet or message:
            return True
        if (packet is None or message is None) and not residue.closed:
            return Wait.WAIT
        limit, final = residue.stretch(at)
        head = data[at : min(limit, at + self._format.overhead + 1)]
        if not head.startswith(self._format.header[: len(head)]):
            return False
        if len(head) <= self._format.overhead:
            return False if final else Wait.WAIT
        return residue.reason(at) in _DAMAGES and head[-1] in self._names


def _starts_message(data: bytes) -> bool | None:
    """Return whether a firmware message starts here; None if more bytes are needed."""
    starts = (firmware.PANIC, firmware.COMMAND_ERROR)
    if data.startswith(starts):
        return True
    return None if any(start.startswith(data) for start in starts) else False
