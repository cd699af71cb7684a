"""Finds frames in a capture by the framing law, knowing the frame format but no commands.

docs/framing.md states the law for unknown firmware: any id is legal, and any LEN up to the longest
of the frame format. The first illegal byte rejects a candidate, and the scan continues one byte
after the start of the candidate. A valid frame is consumed as a whole. This scan looks for unknown
lengths, so it differs in two ways. A known id may have any length. An unknown frame with a known
frame inside it is rejected; otherwise noise would count as an unknown message.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cobotwire_codegen.model import Edition, Frame
from cobotwire_codegen.wire import check_of


@dataclass(frozen=True, slots=True)
class Seen:
    """A frame in the capture; ``offset`` counts bytes; ``direction`` is ``both`` if unknown."""

    offset: int
    id: int
    data: bytes
    frame: bytes
    direction: str = "both"

    @property
    def kind(self) -> tuple[int, int, str]:
        """The id, data length and direction, which all frames of one variant share."""
        return self.id, len(self.data), self.direction


def known_variants(edition: Edition, direction: str) -> set[tuple[int, int]]:
    """Return each id and data length that the edition has in one direction or both."""
    directions = ("request", "reply") if direction == "both" else (direction,)
    return {
        (command.id, sum(field.type.size for field in variant))
        for command in edition.commands
        for each, variants in (("request", command.requests), ("reply", command.replies))
        if each in directions
        for variant in variants
    }


def scan(edition: Edition, line: bytes, known: set[tuple[int, int]]) -> Iterator[Seen]:
    """Return the frames of a capture, in order."""
    start = 0
    while start < len(line):
        start = line.find(edition.frame.header, start)
        if start < 0:
            return
        seen = _frame_at(edition, line, start)
        if seen is None or _hides(edition, line, seen, known):
            start += 1
            continue
        yield seen
        start += len(seen.frame)


def _frame_at(edition: Edition, line: bytes, start: int) -> Seen | None:
    """Return the frame that starts at an offset, or None."""
    frame = edition.frame
    data_at = start + frame.offset("data")
    if not line.startswith(frame.header, start) or len(line) < data_at:
        return None
    legal = frame.address_values
    if legal and line[start + frame.offset("address")] not in legal:
        return None
    length = _number(frame, line, start, "length")
    if not frame.length(0) <= length <= frame.maximum_length:
        return None
    end = data_at + length - frame.length(0) + frame.check_size
    whole = line[start:end]
    body = whole[: len(whole) - frame.check_size]
    if end > len(line) or check_of(frame, body) != whole[len(body) :]:
        return None
    return Seen(start, _number(frame, line, start, "command"), body[data_at - start :], whole)


def _number(frame: Frame, line: bytes, start: int, part: str) -> int:
    form = frame.length_number if part == "length" else frame.command_number
    at = start + frame.offset(part)
    return int.from_bytes(line[at : at + form.width], form.order)


def _hides(edition: Edition, line: bytes, seen: Seen, known: set[tuple[int, int]]) -> bool:
    """Return whether an unknown candidate would hide the start of a known frame."""
    if (seen.id, len(seen.data)) in known:
        return False
    end = seen.offset + len(seen.frame)
    for start in range(seen.offset + 1, end):
        inner = _frame_at(edition, line, start)
        if inner is not None and (inner.id, len(inner.data)) in known:
            return True
    return False
