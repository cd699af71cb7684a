"""Count what an export read, wrote and left out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple


class OutputFile(NamedTuple):
    """A finished file: its path, its rows, and its size in bytes."""

    path: str
    rows: int
    bytes: int


@dataclass
class Report:
    """What an export read and wrote. Reports of several exports add up with :meth:`merge`.

    Every byte of the inputs is in a frame or is noise. Every frame is a row, or counted in
    ``rejected``, ``not_chosen`` or ``outside``.

    Attributes:
        inputs: how many inputs there were.
        bytes: the serial bytes in them, uncompressed, without the overhead of recordings.
        rows: the rows that were written, by message, such as ``get_angles.reply``.
        noise: bytes that belong to no frame, by reason.
        rejected: legal frames with a value that the edition does not allow.
        not_chosen: messages of commands or directions that the plan leaves out.
        outside: messages outside of the plan's time range.
        gaps: pauses between the messages of a recording that are longer than the plan's, by robot.
        truncated: inputs that end too early or are damaged, each with what is missing.
        unread: inputs that are empty or in no known format, each in a sentence.
        notes: how inputs of other programs were read.
        files: the finished files.
    """

    inputs: int = 0
    bytes: int = 0
    rows: Counter[str] = field(default_factory=Counter)
    noise: Counter[str] = field(default_factory=Counter)
    rejected: int = 0
    not_chosen: int = 0
    outside: int = 0
    gaps: Counter[str] = field(default_factory=Counter)
    truncated: list[str] = field(default_factory=list)
    unread: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    files: list[OutputFile] = field(default_factory=list)

    def add(self, other: Report) -> None:
        """Add the counts of another report to this one."""
        self.inputs += other.inputs
        self.bytes += other.bytes
        self.rows.update(other.rows)
        self.noise.update(other.noise)
        self.rejected += other.rejected
        self.not_chosen += other.not_chosen
        self.outside += other.outside
        self.gaps.update(other.gaps)
        self.truncated.extend(other.truncated)
        self.unread.extend(other.unread)
        self.notes.extend(other.notes)
        self.files.extend(other.files)

    @classmethod
    def merge(cls, reports: Iterable[Report]) -> Report:
        """Return the sum of some reports."""
        merged = cls()
        for report in reports:
            merged.add(report)
        return merged

    @property
    def frames(self) -> int:
        """The number of legal frames in the inputs."""
        return self.rows.total() + self.rejected + self.not_chosen + self.outside

    @property
    def clean(self) -> bool:
        """Whether the inputs are complete, and hold nothing but legal frames."""
        damaged = self.noise.total() or self.rejected or self.truncated or self.unread
        return not damaged

    def as_dict(self) -> dict[str, Any]:
        """Return the report as JSON values."""
        return {
            "inputs": self.inputs,
            "bytes": self.bytes,
            "rows": dict(sorted(self.rows.items())),
            "noise": dict(self.noise.most_common()),
            "rejected": self.rejected,
            "not_chosen": self.not_chosen,
            "outside": self.outside,
            "gaps": dict(self.gaps.most_common()),
            "truncated": self.truncated,
            "unread": self.unread,
            "notes": self.notes,
            "files": [file._asdict() for file in self.files],
        }
