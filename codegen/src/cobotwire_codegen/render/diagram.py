"""Draws a message as a row of boxes, with the positions of their bytes above them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

# This width fits a code block of the docs, and a terminal.
WIDTH = 96
# The boxes of these parts show their bytes; the box of a field shows its name.
FIXED = ("header", "LEN", "CMD", "footer")

Row = tuple[str, str, str]


# The position of a part of a message, the label in its box, and its bytes in the example.
Cell = tuple[str, str, str]


def byte_diagram(rows: Iterable[Row], example: bytes = b"") -> str:
    """Return the rows of a byte table (position, content, value) as lines of boxes.

    The bytes of ``example``, a frame of that length, are below the boxes.
    """
    lines: list[list[Cell]] = [[]]
    used = 0
    rows = list(rows)
    for (position, content, value), part in zip(rows, _parts(rows, example)):
        cell = (position, label(content, value), part)
        needed = max(map(len, cell)) + 3
        if lines[-1] and used + needed > WIDTH:
            lines.append([])
            used = 0
        lines[-1].append(cell)
        used += needed
    return "\n".join(_boxes(line) for line in lines)


def label(content: str, value: str) -> str:
    """Return the label of a part of a message: its bytes if they are fixed, otherwise its name."""
    return value if content in FIXED else content.replace("`", "").rpartition(" ")[2]


def _parts(rows: Iterable[Row], example: bytes) -> Iterator[str]:
    """Yield the bytes of each part of an example; empty if the sizes of several parts vary."""
    widths = [width(position) for position, _, _ in rows]
    rest = len(example) - sum(filter(None, widths))
    for each in widths:
        size = rest if each is None else each
        yield example[:size].hex(" ").upper() if widths.count(None) < 2 else ""
        example = example[size:]


def width(position: str) -> int | None:
    """Return the number of bytes at positions such as ``4-7`` or ``n+1..n+2``.

    None if it varies, as ``4-n``.
    """
    first, _, last = position.replace("..", "-").partition("-")
    if last.isalpha():
        return None
    ends = [int(end.rpartition("+")[2]) for end in (first, last or first)]
    return ends[1] - ends[0] + 1


def _boxes(cells: list[Cell]) -> str:
    widths = [max(map(len, cell)) for cell in cells]
    above, below = (
        "".join(f"  {cell[at]:<{w}} " for cell, w in zip(cells, widths)).rstrip() for at in (0, 2)
    )
    inside = "".join(f"│ {label:<{w}} " for (_, label, _), w in zip(cells, widths))
    edges = ["─" * (w + 2) for w in widths]
    boxes = (f"┌{'┬'.join(edges)}┐", f"{inside}│", f"└{'┴'.join(edges)}┘")
    return "\n".join((above, *boxes, *filter(None, [below])))
