"""The counts of a campaign, a row for each profile, as text and as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

# The outcomes that must never occur.
FORBIDDEN = ("wrong", "exceptions", "duplicates", "lost", "late", "merged")
# The counts, in the order of the table, by their headings; docs/contribute/attack.md explains them.
COLUMNS = {
    "calls": "calls",
    "right": "right",
    "honest error": "honest",
    "interrupted": "interrupted",
    "wrong, known limit": "limited",
    "**silently wrong**": "wrong",
    "**exception**": "exceptions",
    "**duplicate**": "duplicates",
    "**lost**": "lost",
    "**late**": "late",
    "late, machine stalled": "stalled",
    "**merged**": "merged",
}


@dataclass
class Tally:
    """The outcomes of the calls of a profile.

    Attributes:
        profile: the name of the row.
        counts: the number of calls with each outcome, by the names in ``COLUMNS``.
        limits: the number of wrong values that each limit of the protocol explains.
        failures: the first failures of each run, in words.
    """

    profile: str
    counts: Counter[str] = field(default_factory=Counter)
    limits: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)

    @property
    def forbidden(self) -> int:
        """The number of forbidden outcomes."""
        return sum(self.counts[name] for name in FORBIDDEN)

    def add(self, other: Tally) -> None:
        """Add the counts of another run."""
        self.counts += other.counts
        self.limits += other.limits
        self.failures += other.failures


def rows(tallies: Sequence[Tally]) -> list[list[str]]:
    """Return the cells of the table: its heading, a row for each profile and one for all."""
    cells = [
        [each.profile, *(f"{each.counts[name]:,}" for name in COLUMNS.values())]
        for each in (*tallies, total(tallies))
    ]
    return [["profile", *COLUMNS], *cells]


def total(tallies: Sequence[Tally]) -> Tally:
    """Return the sum of the counts."""
    found = Tally("all")
    for tally in tallies:
        found.add(tally)
    return found


def text(tallies: Sequence[Tally]) -> str:
    """Return the table for a terminal; the columns that must be 0 have a star."""
    headings, *cells = rows(tallies)
    table = [[each.replace("**", "*", 1).replace("**", "") for each in headings], *cells]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return "\n".join(
        "  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in table
    )


def markdown(tallies: Sequence[Tally]) -> str:
    """Return the table for a page, without the columns that are 0."""
    cells = [column for column in zip(*rows(tallies), strict=True) if column[-1] != "0"]
    headings, *table = zip(*cells, strict=True)
    table = [headings, ("---", *["---:"] * (len(cells) - 1)), *table]
    return "".join(f"| {' | '.join(row)} |\n" for row in table)
