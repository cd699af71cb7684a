"""The counts of a campaign: one row of the table a profile."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass
class Tally:
    """What became of the calls of a profile.

    Attributes:
        profile: the name of the row.
        calls: all calls.
        right: got the value that the arm made for them, or did what they say.
        honest: ended with a documented error.
        interrupted: ended by Ctrl-C, or were cancelled.
        limits: got a wrong value that a documented limit of the protocol explains, by its name.
        wrong: got a wrong value, or sent nothing, without an error, and no limit explains it.
        exceptions: ended with an exception of an undocumented type.
        duplicates: motions and settings that arrived more often than they were called.
        lost: never ended.
        late: ended later than their deadline and 0.1 s.
        stalled: likewise, but the machine stalled for as long.
        merged: legal requests at the arm that no call sent.
        failures: the first failures of each run, in words.
    """

    profile: str
    calls: int = 0
    right: int = 0
    honest: int = 0
    interrupted: int = 0
    limits: dict[str, int] = field(default_factory=dict)
    wrong: int = 0
    exceptions: int = 0
    duplicates: int = 0
    lost: int = 0
    late: int = 0
    stalled: int = 0
    merged: int = 0
    failures: list[str] = field(default_factory=list)

    @property
    def forbidden(self) -> int:
        """How often happened what must never happen."""
        return self.wrong + self.exceptions + self.duplicates + self.lost + self.late + self.merged

    @property
    def limited(self) -> int:
        """How many calls a documented limit of the protocol made wrong."""
        return sum(self.limits.values())

    def add(self, other: Tally) -> None:
        """Add the counts of another run."""
        for name in ("calls", "right", "honest", "interrupted", *FORBIDDEN, "stalled"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        for limit, count in other.limits.items():
            self.limits[limit] = self.limits.get(limit, 0) + count
        self.failures += other.failures

    def as_json(self) -> dict[str, Any]:
        """Return the counts for machines."""
        return asdict(self)


FORBIDDEN = ("wrong", "exceptions", "duplicates", "lost", "late", "merged")
