"""Check whether bytes are a legal frame. The framer and the decoder both use this check."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.codec.events import NoiseReason
from cobotwire.protocol.frame_format import FixedPart, FrameFormat
from cobotwire.protocol.frame_index import FrameIndex, MessageVariant
from cobotwire.protocol.table import Command


class Heading(NamedTuple):
    """The command id and the LEN of a candidate."""

    id: int
    length: int


class Validator:
    """Validates candidates by the messages of some directions; earlier directions take precedence.

    With ``accept_unknown`` an id that the edition lacks may have any LEN up to the maximum.
    """

    def __init__(
        self, frame: FrameFormat, indexes: Sequence[FrameIndex], accept_unknown: bool = False
    ) -> None:
        self.frame = frame
        self.indexes = indexes
        self.accept_unknown = accept_unknown
        self._lengths = set().union(*(index.lengths for index in indexes))
        if accept_unknown:
            self._lengths |= set(range(frame.length(0), frame.maximum_length + 1))
        # Computed once: every frame needs them.
        self._addresses = frozenset(frame.addresses)
        self._longest = frame.overhead + max(self._lengths, default=0)

    def validate(self, data: bytes, start: int = 0) -> int | NoiseReason:
        """Return the size of the frame at ``start``, or the reason why no frame is there.

        ``truncated`` means that more bytes could complete a frame.
        """
        frame = self.frame
        rest = data[start : start + max(self._longest, frame.head_size)]
        heading = self.heading(rest)
        if isinstance(heading, str):
            return heading
        reason = self.reject(heading)
        if reason is not None:
            return reason
        size = frame.overhead + heading.length
        if len(rest) < size:
            return "truncated"
        end = size - frame.check_size
        return size if rest[end:size] == frame.end(rest[:end]) else "bad-check"

    def heading(self, rest: bytes) -> Heading | NoiseReason:
        """Return the heading of a candidate at the start of ``rest``, or why it is rejected.

        The parts are validated in their order on the wire, each when its last byte has come.
        """
        frame = self.frame
        if not frame.header.startswith(rest[: len(frame.header)]):
            return "no-header"
        for part in frame.layout:
            reason = self._reject_part(part, rest)
            if reason is not None:
                return reason
        return self.heading_of(rest) if len(rest) >= frame.head_size else "truncated"

    def _reject_part(self, part: FixedPart, rest: bytes) -> NoiseReason | None:
        """Return why a fixed part by itself is illegal; None if it is legal or incomplete."""
        frame, size = self.frame, len(rest)
        if part == "address":
            at = frame.address_at
            bad = at is not None and at < size and rest[at] not in self._addresses
            return "bad-address" if bad else None
        if part == "length":
            come = frame.length_at + frame.length_number.width <= size
            return "bad-length" if come and frame.read_length(rest) not in self._lengths else None
        if self.accept_unknown or frame.id_at + frame.id_number.width > size:
            return None
        # If the id follows LEN, the two are validated together.
        follows = frame.id_at > frame.length_at
        known = follows or any(index.has(frame.read_id(rest)) for index in self.indexes)
        return None if known else "unknown-id"

    def messages(self, heading: Heading, of: Command | None = None) -> list[MessageVariant]:
        """Return the messages that a frame can be; only those of the command ``of``, if given."""
        return [
            message
            for index in self.indexes
            for message in index.find(heading.id, heading.length)
            if of is None or message.command is of
        ]

    def misnamed(self, heading: Heading, of: Command | None) -> NoiseReason | None:
        """Return why a heading cannot belong to the command ``of``; None if it can."""
        if of is None or self.messages(heading, of):
            return None
        has_id = any(self.frame.has_id(index.direction) for index in self.indexes)
        return "bad-length" if heading.id == of.id or not has_id else "unknown-id"

    def reject(self, heading: Heading) -> NoiseReason | None:
        """Return why no legal frame has that heading; None if a frame can have it."""
        if self.messages(heading):
            return None
        if any(index.has(heading.id) for index in self.indexes):
            return "bad-length"
        return None if self.accept_unknown else "unknown-id"

    def heading_of(self, frame: bytes) -> Heading:
        """Return the heading of a frame that is known to be legal."""
        return Heading(self.frame.read_id(frame), self.frame.read_length(frame))
