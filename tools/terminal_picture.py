"""Run programs on terminals, and draw what their screens show over time as an animated SVG.

The animation is SMIL, which a browser also plays in an ``<img>``. Each different row of a line is
written once, below the one before it, and a window of one row's height moves over them.
"""

from __future__ import annotations

import fcntl
import os
import select
import struct
import subprocess
import termios
import time
from collections.abc import Sequence
from html import escape
from itertools import groupby
from types import TracebackType
from typing import NamedTuple, Self

import pyte

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


class Terminal:
    """A program on a terminal of ``columns`` and ``lines``, as long as the ``with`` block runs."""

    def __init__(self, *words: str, columns: int, lines: int, **environment: str) -> None:
        self._master, slave = os.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("4H", lines, columns, 0, 0))
        self._screen = pyte.Screen(columns, lines)
        self._stream = pyte.ByteStream(self._screen)
        self._process = subprocess.Popen(  # noqa: S603  (the words are this program's own)
            words,
            stdin=slave,
            stdout=slave,
            stderr=slave,
            start_new_session=True,
            env={**os.environ, "TERM": "xterm-256color", **environment},
        )
        os.close(slave)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._process.kill()
        self._process.wait()
        os.close(self._master)

    def type(self, keys: str) -> None:
        """Send keys to the program."""
        os.write(self._master, keys.encode())

    def text(self) -> str:
        """Return the rows of the screen as text."""
        return "\n".join(row.rstrip() for row in self._screen.display)

    def read(self) -> None:
        """Take what the program has written since the last call."""
        while select.select([self._master], [], [], 0)[0]:
            try:
                self._stream.feed(os.read(self._master, 65536))
            except OSError:  # the program has ended
                return

    def until(self, shown: str, seconds: float = 20.0) -> None:
        """Read until the screen shows a text.

        Raises:
            TimeoutError: it did not show the text in time; the error has the screen.
        """
        end = time.monotonic() + seconds
        while shown not in self.text():
            if time.monotonic() > end:
                raise TimeoutError(f"the screen does not show {shown!r}:\n{self.text()}")
            select.select([self._master], [], [], 0.1)
            self.read()

    def screen(self) -> Screen:
        """Return what the screen shows."""
        return tuple(self._row(line) for line in range(self._screen.lines))

    def _row(self, line: int) -> Row:
        cells = [(x, self._screen.buffer[line][x]) for x in range(self._screen.columns)]
        spans = []
        for (colour, bold), group in groupby(cells, lambda cell: (cell[1].fg, cell[1].bold)):
            found = list(group)
            text = "".join(cell.data for _, cell in found)
            if text.strip():
                spans.append(Span(found[0][0], text.rstrip(), COLOURS.get(colour, colour), bold))
        return tuple(spans)


class Film(NamedTuple):
    """The screens of a terminal, one a frame, drawn with cells of ``width`` by ``height``."""

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
        """Return a window of one line's height, below which the rows of the frames pass."""
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
