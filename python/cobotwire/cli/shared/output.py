"""Print lines, and format values, for people and as JSON."""

from __future__ import annotations

import os
import re
import sys
from enum import IntEnum
from functools import partial
from shutil import get_terminal_size
from typing import TYPE_CHECKING, Any

import click

from cobotwire.protocol.printable import printable

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as Grid

WIDTH_OF_FILES = 200
# Columns that a live table leaves free: the terminal echoes ^C after its last row.
ECHO_COLUMNS = 3


def print_line(line: str) -> None:
    """Print a line at once; do nothing if the reader of the output has closed it.

    Do not call this while a live table is shown: the line would be written into it.
    """
    try:
        click.echo(line)
    except BrokenPipeError:
        discard_output()


def report_written(path: str) -> None:
    """Print to standard error which file was written; standard output is for results."""
    click.echo(f"wrote {printable(path)}", err=True)


def discard_output() -> None:
    """Redirect standard output to nowhere, so that no later write or flush fails."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)


def fold(text: str, *, err: bool = False) -> str:
    """Break long lines between words on a terminal, which would break them anywhere.

    The following rows are indented to the last column that starts in the terminal's left half.
    """
    if not (sys.stderr if err else sys.stdout).isatty():
        return text
    width = get_terminal_size().columns
    return "\n".join(map(partial(_fold_line, width=width), text.split("\n")))


def _fold_line(line: str, width: int) -> str:
    plain = click.unstyle(line)
    if len(plain) <= width:
        return line
    first, *others = (column.end() for column in re.finditer(r"^ *|  +", plain))
    indent = max([first + 2, *(at for at in others if at <= width // 2)])
    rows, end = [""], 0
    for word in line.split(" "):
        size = len(click.unstyle(word))
        if rows[-1].strip() and end + size > width:
            rows.append(" " * indent)
            end = indent
        if word or len(rows) == 1 or rows[-1].strip():
            rows[-1] += f"{word} "
            end += size + 1
    return "\n".join(row.rstrip(" ") for row in rows)


def plain_console() -> Console:
    """Return a console that prints text as it is: ``[word]`` and ``:word:`` are not markup."""
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        # Long lines are not broken, for grep and the like.
        console.width = WIDTH_OF_FILES
    return console


def print_grid(grid: Grid) -> None:
    """Print a grid; into a file or a pipe without the spaces at the ends of lines."""
    console = plain_console()
    if console.is_terminal:
        console.print(grid)
        return
    with console.capture() as capture:
        console.print(grid)
    click.echo("\n".join(line.rstrip() for line in capture.get().splitlines()))


def as_hex(data: bytes) -> str:
    """Return bytes as pairs of hex digits."""
    return data.hex(" ").upper()


def format_result(value: Any) -> str:
    """Format a result on one line, for people."""
    if hasattr(value, "_asdict"):
        text = "  ".join(f"{name}={part}" for name, part in value._asdict().items())
    else:
        text = value.name if isinstance(value, IntEnum) else str(value)
    # A text reply holds whatever the arm sent.
    return printable(text)
