"""Draw what the screens of terminals show over time as an animated SVG.

The animation is SMIL, which a browser also plays in an ``<img>``. For each line of the terminal,
the different texts are written once, one below the other. The animation moves them within a clipped
area of one line's height, so that one text is visible at a time.
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from itertools import groupby
from typing import NamedTuple

import pyte

from terminal import Terminal

FONT = "ui-monospace, SFMono-Regular, Menlo, Consolas, 'DejaVu Sans Mono', monospace"
# The colours of the terminal; pyte calls the default colour "default".
COLOURS = {
    "default": "#d8dee9",
    "red": "#ff7b72",
    "green": "#7ee787",
    "brown": "#e3b341",
    "blue": "#79c0ff",
    "magenta": "#d2a8ff",
    "cyan": "#76e3ea",
}


class Span(NamedTuple):
    """Neighbouring characters of a row that look alike: where they start, and how they look."""

    column: int
    text: str
    colour: str
    bold: bool


# A space that is not joined with its neighbours.
GAP = "\N{NO-BREAK SPACE}"
BOLD = ' font-weight="bold"'

Row = tuple[Span, ...]
Screen = tuple[Row, ...]


def screen_of(terminal: Terminal) -> Screen:
    """Return what the screen shows."""
    return tuple(_row(terminal.emulated, line) for line in range(terminal.emulated.lines))


def _row(screen: pyte.Screen, line: int) -> Row:
    cells = [(x, screen.buffer[line][x]) for x in range(screen.columns)]
    spans = []
    for (colour, bold), group in groupby(cells, lambda cell: (cell[1].fg, cell[1].bold)):
        found = list(group)
        text = "".join(cell.data for _, cell in found)
        if text.strip():
            spans.append(Span(found[0][0], text.rstrip(), COLOURS.get(colour, colour), bold))
    return tuple(spans)


class Film(NamedTuple):
    """The screens of a terminal, one per frame, drawn with cells of ``width`` by ``height``."""

    screens: Sequence[Screen]
    width: float
    height: float

    def svg(self, still: int | None, seconds: float) -> str:
        """Return the film as SVG; with ``still``, only the frame with that number."""
        shown = self.screens if still is None else [self.screens[still]]
        lines = (
            self._line(line, [screen[line] for screen in shown], seconds)
            for line in range(len(shown[0]))
        )
        return "\n".join(filter(None, lines))

    def _line(self, line: int, rows: list[Row], seconds: float) -> str:
        """Return an area as high as one line, within which the texts of the frames move."""
        different = list(dict.fromkeys(rows))
        if different == [()]:
            return ""
        texts = "".join(self._row(row, place) for place, row in enumerate(different))
        changes = [
            frame for frame in range(len(rows)) if frame == 0 or rows[frame] != rows[frame - 1]
        ]
        if len(changes) > 1:
            places = [-different.index(rows[frame]) * self.height for frame in changes]
            times = [f"{frame / len(rows):.4f}".rstrip("0").rstrip(".") for frame in changes]
            texts = (
                f'<g transform="translate(0 {-different.index(rows[-1]) * self.height:g})">{texts}'
                '<animateTransform attributeName="transform" type="translate" calcMode="discrete"'
                f' dur="{seconds:g}s" repeatCount="indefinite" keyTimes="{";".join(times)}"'
                f' values="{";".join(f"0 {place:g}" for place in places)}"/></g>'
            )
        place = f'y="{line * self.height:g}" height="{self.height:g}"'
        return f'<svg {place} overflow="hidden">{texts}</svg>'

    def _row(self, row: Row, place: int) -> str:
        y = (place + 0.74) * self.height
        return "".join(
            f'<text x="{span.column * self.width:.1f}" y="{y:g}"'
            f' textLength="{len(span.text) * self.width:.1f}" lengthAdjust="spacingAndGlyphs"'
            f' fill="{span.colour}"{BOLD * span.bold}>{escape(span.text).replace(" ", GAP)}</text>'
            for span in row
        )
