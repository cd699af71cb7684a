"""Check whether bytes are a legal frame. The framer and the decoder both use this check."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.codec.events import NoiseReason
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire.protocol.frame_index import FrameIndex, MessageVariant
from cobotwire.protocol.table import Command


class Heading(NamedTuple):
    """The command id and the LEN of a candidate."""

    id: int
    length: int


class Judge:
    """Judges candidates by the messages of some directions; earlier directions take precedence.

    With ``accept_unknown`` an id that the edition lacks may have any LEN up to the maximum.
    """

    def __init__(
        self, frame: FrameFormat, indexes: Sequence[FrameIndex], accept_unknown: bool = False
    ) -> None:
        self.frame = frame
        self.indexes = indexes
        self.accept_unknown = accept_unknown
        # Computed once: every frame needs them several times.
        self.overhead, self.length_at = frame.overhead, frame.length_at
        self._lengths = set().union(*(index.lengths for index in indexes))
        if accept_unknown:
            self._lengths |= set(range(frame.length(0), frame.maximum_length + 1))

    def judge(self, data: bytes, start: int = 0) -> int | NoiseReason:
        """Return the size of the frame at ``start``, or the reason why no frame is there.

        ``truncated`` means that more bytes could complete a frame.
        """
        frame = self.frame
        rest = data[start : start + self.overhead + 256]
        heading = self.heading(rest)
        if isinstance(heading, str):
            return heading
        reason = self.refute(heading)
        if reason is not None:
            return reason
        size = self.overhead + heading.length
        if len(rest) < size:
            return "truncated"
        end = size - frame.check_size
        return size if rest[end:size] == frame.end(rest[:end]) else "bad-check"

    def heading(self, rest: bytes) -> Heading | NoiseReason:
        """Return the heading of a candidate at the start of ``rest``, or why it is refuted."""
        frame = self.frame
        if not frame.header.startswith(rest[: len(frame.header)]):
            return "no-header"
        address = rest[len(frame.header) : self.length_at]
        if address and address[0] not in frame.addresses:
            return "bad-address"
        if len(rest) < self.overhead:
            return "truncated"
        length = rest[self.length_at]
        if length not in self._lengths:
            return "bad-length"
        return Heading(rest[self.overhead], length) if len(rest) > self.overhead else "truncated"

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
        return "bad-length" if heading.id == of.id else "unknown-id"

    def refute(self, heading: Heading) -> NoiseReason | None:
        """Return why no legal frame has that heading; None if a frame can have it."""
        if self.messages(heading):
            return None
        if any(index.has(heading.id) for index in self.indexes):
            return "bad-length"
        return None if self.accept_unknown else "unknown-id"

    def heading_of(self, frame: bytes) -> Heading:
        """Return the heading of a frame that is known to be legal."""
        return Heading(frame[self.overhead], frame[self.length_at])
