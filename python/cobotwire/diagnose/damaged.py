"""Recognise damaged frames: header and id of a command, but no legal frame."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from cobotwire.codec.interface import Codec, Listening, NoiseReason
from cobotwire.diagnose.findings import Finding, Span
from cobotwire.diagnose.firmware import starts_message
from cobotwire.diagnose.frames import DIRECTIONS, FrameStarts
from cobotwire.diagnose.panic import PANIC
from cobotwire.diagnose.residue import Residue, Verdict, Wait
from cobotwire.diagnose.servo import packet_size

# What is wrong, by the framer's reason.
_DAMAGES = {
    "bad-length": "its LEN is wrong",
    "bad-check": "its end or check is wrong",
    "truncated": "it is cut off",
}
# A damaged frame may have a few bytes more or less than an undamaged one; nearest first.
_SLACK = (0, -1, 1, -2, 2)


@dataclass(frozen=True, slots=True, kw_only=True)
class DamagedFrame(Finding):
    """The header and id of a command without a legal frame.

    ``command`` names every command with the id. Command and id are None if the frame is cut before
    its id, or if it may be a reply that carries no id.
    """

    command: str | None
    id: int | None
    kind: ClassVar[str] = "damaged-frame"
    advice: ClassVar[str] = (
        "bytes get lost: try another cable or USB socket, and check whether another program reads "
        "from this port"
    )
    summary_noun: ClassVar[str] = "damaged frame"

    def of_command(self, name: str) -> Self:
        """Return the finding with the name of the command that it belongs to."""
        return replace(self, command=name)

    def describe(self) -> str:
        """Describe the damage."""
        return f"damaged {self.command or 'frame'}: {_DAMAGES.get(self.reason, self.reason)}"


class DamagedFrames(FrameStarts):
    """Recognises what starts like a frame, where :class:`~.frames.Frames` found no whole frame."""

    def __init__(self, codec: Codec, listening: Listening) -> None:
        super().__init__(codec, listening)
        # Every LEN that is legal with an id, in any direction; for the id None, every legal LEN.
        self._lengths: dict[int | None, set[int]] = {}
        # All names of each id: if commands share an id, a damaged frame does not show which it is.
        self._all_names: dict[int, str] = {}
        for command in codec.table.commands:
            legal = {
                self._format.length(v.size, d) for d in DIRECTIONS for v in command.variants(d)
            }
            for key in (command.id, None):
                self._lengths.setdefault(key, set()).update(legal)
            before = self._all_names.get(command.id)
            self._all_names[command.id] = f"{before} or {command.name}" if before else command.name

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """Recognise what is left of a frame at ``at``."""
        head, limit, final = self._head(residue, at)
        if head is None:
            return None
        if len(head) < self._format.head_size:
            return self._start_only(residue, at, limit) if final else Wait.WAIT
        id, reason = self._id(head), residue.reason(at)
        if reason not in _DAMAGES or id not in self._lengths:
            return None
        extent = self._extent(residue, at, id)
        if isinstance(extent, Wait):
            return extent
        return self.damaged(residue.spans(at, extent), reason, id)

    def damaged(self, spans: tuple[Span, ...], reason: NoiseReason, id: int | None) -> DamagedFrame:
        """Return what is left of a frame with that id, which is None if it is not known."""
        name = None if id is None else self._all_names[id]
        return DamagedFrame(spans=spans, reason=reason, command=name, id=id)

    def _start_only(self, residue: Residue, at: int, limit: int) -> Finding | None:
        """Return the start of a frame that is cut before its id."""
        if residue.reason(at) != "truncated":
            return None
        return self.damaged(residue.spans(at, limit), "truncated", None)

    def _extent(self, residue: Residue, at: int, id: int | None) -> int | Wait:
        """Return the end of the damaged frame: after a footer near a legal end, or else by LEN.

        A byte may have been inserted or lost, so the footer is also searched after the end. A
        frame, a servo packet or a firmware message that starts inside ends the damaged frame.
        """
        limit, final = residue.segment_end(at)
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
        format, lengths = self._format, self._lengths[id]
        claimed = format.read_length(residue.data, at)
        for length in sorted(lengths, key=lambda length: (length != claimed, length)):
            for extra in _SLACK if format.check is None else ():
                end = at + format.overhead + length + extra
                if end <= limit and residue.data.startswith(format.footer, end - format.check_size):
                    return end
        return min(limit, at + format.overhead + (claimed if claimed in lengths else max(lengths)))

    def _stops(self, residue: Residue, at: int) -> bool | Wait:
        """Return whether something else starts at ``at``, inside a damaged frame."""
        data = residue.data
        packet = packet_size(data, at)
        message = starts_message(data[at : at + len(PANIC)])
        if packet or message:
            return True
        if (packet is None or message is None) and not residue.closed:
            return Wait.WAIT
        head, _, final = self._head(residue, at)
        if head is None:
            return False
        if len(head) < self._format.head_size:
            return False if final else Wait.WAIT
        return residue.reason(at) in _DAMAGES and self._id(head) in self._lengths
