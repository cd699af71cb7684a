"""Draws a message as a row of boxes with the numbers of their bytes above."""

from __future__ import annotations

from collections.abc import Iterable

# This width fits a code block of the docs, and a terminal.
WIDTH = 96
# These boxes show their value, which is fixed; a field's box shows its name.
FIXED = ("header", "LEN", "CMD", "footer")

Row = tuple[str, str, str]


def byte_diagram(rows: Iterable[Row]) -> str:
    """Return the rows of a byte table (position, content, value) as lines of boxes."""
    lines: list[list[tuple[str, str]]] = [[]]
    used = 0
    for position, content, value in rows:
        label = value if content in FIXED else content.replace("`", "").rpartition(" ")[2]
        width = max(len(position), len(label)) + 3
        if lines[-1] and used + width > WIDTH:
            lines.append([])
            used = 0
        lines[-1].append((position, label))
        used += width
    return "\n".join(_boxes(line) for line in lines)


def _boxes(cells: list[tuple[str, str]]) -> str:
    widths = [max(map(len, cell)) for cell in cells]
    above = "".join(f"  {position:<{w}} " for (position, _), w in zip(cells, widths))
    inside = "".join(f"│ {label:<{w}} " for (_, label), w in zip(cells, widths))
    edges = ["─" * (w + 2) for w in widths]
    return "\n".join((above.rstrip(), f"┌{'┬'.join(edges)}┐", f"{inside}│", f"└{'┴'.join(edges)}┘"))
