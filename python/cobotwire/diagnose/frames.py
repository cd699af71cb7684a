"""Frames that the framer did not take: of the other direction, unknown, or damaged."""

from __future__ import annotations

from collections import deque

from cobotwire.codec.interface import Codec, Frame, Listening
from cobotwire.diagnose import firmware, servo
from cobotwire.diagnose.findings import DamagedFrame, Finding, OtherWay, UnlistedFrame
from cobotwire.diagnose.residue import Residue, Verdict, Wait
from cobotwire.table import Command, Direction

_DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
# So many requests are remembered, to tell their echo.
REMEMBERED = 8
# A damaged frame may have so many bytes more or less than an undamaged one; nearest first.
_SLACK = (0, -1, 1, -2, 2)
_DAMAGES = ("bad-length", "bad-check", "truncated")
_OTHER: dict[Listening, Direction] = {"request": "reply", "reply": "request"}


class Frames:
    """Recognises what starts like a frame of the edition, in noise heard in one direction."""

    def __init__(self, codec: Codec, listening: Listening) -> None:
        self._format = codec.table.frame
        self._longest = self._format.overhead + self._format.maximum_length
        self._by_id: dict[int, list[Command]] = {}
        for command in codec.table.commands:
            self._by_id.setdefault(command.id, []).append(command)
        self._other = _OTHER.get(listening)
        # A framer is the law of framing itself, so that it is not said a second time here.
        self._other_framer = None if self._other is None else codec.framer(self._other)
        self._any_framer = codec.framer(listening, accept_unknown=True)
        self._listed = {
            command.id
            for command in codec.table.commands
            for direction in _DIRECTIONS
            if direction != self._other and command.layouts(direction)
        }
        self._sent: deque[bytes] = deque(maxlen=REMEMBERED)

    def sent(self, data: bytes) -> None:
        """Note a request that goes out."""
        if data:
            self._sent.append(bytes(data))

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """The frame, or what is left of one, at ``at``."""
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
            whole = self._whole(residue, at, end) if end <= limit else None
            if whole is not None:
                return whole
        return self._damaged(residue, at)

    def _echo(self, residue: Residue, at: int, limit: int, final: bool) -> Verdict:
        waits = False
        for request in self._sent:
            here = residue.data[at : min(limit, at + len(request))]
            if here == request:
                command = self._named(request, "request")
                name = command.name if command else "unknown"
                return OtherWay(
                    spans=residue.spans(at, at + len(request)),
                    reason=residue.reason(at),
                    command=name,
                    direction="request",
                    sent=True,
                )
            waits = waits or (not final and request.startswith(here))
        return Wait.WAIT if waits else None

    def _start_only(self, residue: Residue, at: int, limit: int) -> Finding | None:
        """A start of a frame that broke off before its id."""
        if residue.reason(at) != "truncated":
            return None
        spans = residue.spans(at, limit)
        return DamagedFrame(spans=spans, reason="truncated", command=None, id=None)

    def _whole(self, residue: Residue, at: int, end: int) -> Finding | None:
        data, spans, reason = residue.data[at:end], residue.spans(at, end), residue.reason(at)
        id = data[self._format.overhead]
        if self._other is not None and self._other_framer is not None:
            heard = [*self._other_framer.feed(data), *self._other_framer.flush()]
            if len(heard) == 1 and isinstance(heard[0], Frame):
                command = self._named(data, self._other)
                assert command is not None, "the framer knows its id"
                return OtherWay(
                    spans=spans,
                    reason=reason,
                    command=command.name,
                    direction=self._other,
                    sent=False,
                )
        if id in self._listed:
            return None
        heard = [*self._any_framer.feed(data), *self._any_framer.flush()]
        if len(heard) != 1 or not isinstance(heard[0], Frame):
            return None
        name = self._by_id[id][0].name if id in self._by_id else None
        return UnlistedFrame(spans=spans, reason=reason, id=id, command=name)

    def _named(self, data: bytes, direction: Direction) -> Command | None:
        """The command of a frame; of those that share its id, the first of that size."""
        if len(data) <= self._format.overhead:
            return None
        commands = self._by_id.get(data[self._format.overhead], [])
        size = len(data) - self._format.overhead - self._format.length(0)
        fitting = [c for c in commands if any(f.size == size for f in c.layouts(direction))]
        return next(iter([*fitting, *commands]), None)

    def _damaged(self, residue: Residue, at: int) -> Verdict:
        commands = self._by_id.get(residue.data[at + self._format.overhead], [])
        reason = residue.reason(at)
        if reason not in _DAMAGES or not commands:
            return None
        extent = self._extent(residue, at, commands)
        if isinstance(extent, Wait):
            return extent
        spans = residue.spans(at, extent)
        return DamagedFrame(spans=spans, reason=reason, command=commands[0].name, id=commands[0].id)

    def _extent(self, residue: Residue, at: int, commands: list[Command]) -> int | Wait:
        """How far the damaged frame reaches: to a footer near a legal end, else as LEN says.

        A byte may have been inserted or lost, so the footer is also looked for behind the end. A
        frame, a servo packet or a message of the firmware that starts inside ends it.
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
        sizes = {format.length(f.size) for c in commands for f in (*c.request, *c.reply)}
        claimed = residue.data[at + format.length_at]
        for size in sorted(sizes, key=lambda size: (size != claimed, size)):
            for extra in _SLACK if format.check == "footer" else ():
                end = at + format.overhead + size + extra
                if end <= limit and residue.data.startswith(format.footer, end - format.check_size):
                    return end
        return min(limit, at + format.overhead + (claimed if claimed in sizes else max(sizes)))

    def _stops(self, residue: Residue, at: int) -> bool | Wait:
        """Whether something else starts at ``at``, inside a damaged frame."""
        data = residue.data
        packet = servo.size_of(data[at : at + servo.LONGEST])
        said = _said(data[at : at + len(firmware.PANIC)])
        if packet or said:
            return True
        if (packet is None or said is None) and not residue.closed:
            return Wait.WAIT
        limit, final = residue.stretch(at)
        head = data[at : min(limit, at + self._format.overhead + 1)]
        if not head.startswith(self._format.header[: len(head)]):
            return False
        if len(head) <= self._format.overhead:
            return False if final else Wait.WAIT
        return residue.reason(at) in _DAMAGES and head[-1] in self._by_id


def _said(data: bytes) -> bool | None:
    """Whether the firmware speaks here; None: more bytes decide."""
    words = (firmware.PANIC, firmware.COMMAND_ERROR)
    if data.startswith(words):
        return True
    return None if any(word.startswith(data) for word in words) else False
