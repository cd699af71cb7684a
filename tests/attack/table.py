"""The table of a campaign, as text and as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from attack.tally import Tally

HEADINGS = (
    "profile",
    "calls",
    "right",
    "honest error",
    "interrupted",
    "wrong, by a limit",
    "**silently wrong**",
    "**exception**",
    "**duplicate**",
    "**lost**",
    "**late**",
    "late, machine stalled",
    "**merged**",
)


def rows(tallies: Sequence[Tally]) -> list[list[str]]:
    """Return the cells of the table, a row for each profile and one for all."""
    total = Tally("all")
    for tally in tallies:
        total.add(tally)
    return [_cells(tally) for tally in (*tallies, total)]


def text(tallies: Sequence[Tally]) -> str:
    """Return the table for a terminal; the columns that must be 0 have a star."""
    headings = [heading.replace("**", "*", 1).replace("**", "") for heading in HEADINGS]
    table = [headings, *rows(tallies)]
    widths = [max(len(row[column]) for row in table) for column in range(len(headings))]
    return "\n".join(
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths))
        ).rstrip()
        for row in table
    )


def markdown(tallies: Sequence[Tally]) -> str:
    """Return the table for a page."""
    lines = [list(HEADINGS), ["---"] + ["---:"] * (len(HEADINGS) - 1), *rows(tallies)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def limits(tallies: Sequence[Tally]) -> dict[str, int]:
    """Return how often each limit explains a wrong value, over all profiles."""
    found: dict[str, int] = {}
    for tally in tallies:
        for name, count in tally.limits.items():
            found[name] = found.get(name, 0) + count
    return dict(sorted(found.items()))


def _cells(tally: Tally) -> list[str]:
    counts = (
        tally.calls,
        tally.right,
        tally.honest,
        tally.interrupted,
        tally.limited,
        tally.wrong,
        tally.exceptions,
        tally.duplicates,
        tally.lost,
        tally.late,
        tally.stalled,
        tally.merged,
    )
    return [tally.profile, *(f"{count:,}" for count in counts)]
