"""Runs a page of the guide: its files are written, its commands run, and their output compared.

A block of code with ``<!-- file: NAME -->`` in front is a file, with ``append:`` more of one. In a
block ``console`` each line that starts with ``$`` is a command; what follows is what it prints, and
a line ``...`` stands for any lines. Other blocks are left alone.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

BLOCK = re.compile(
    r"(?:^<!-- (?P<how>file|append): (?P<name>\S+) -->\n)?^```(?P<kind>\w+)\n(?P<text>.*?)^```$",
    re.DOTALL | re.MULTILINE,
)
SECONDS = 60
PORT = "/dev/ttyACM0"


class Ran(NamedTuple):
    """A command of a page, what it should print, and what it did."""

    command: str
    right: str
    printed: str

    @property
    def fits(self) -> bool:
        """Whether it printed what the page says."""
        pattern = re.escape(self.right).replace(re.escape("...\n"), r"(?:.*\n)*?")
        return re.fullmatch(pattern, self.printed) is not None


def run(page: Path, folder: Path, port: str) -> Iterator[Ran]:
    """Everything on a page, in its order; ``port`` takes the place of the page's."""
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        text = block["text"]
        if block["how"]:
            mode = "a" if block["how"] == "append" else "w"
            with (folder / block["name"]).open(mode) as file:
                file.write(text.replace(PORT, port))
        elif block["kind"] == "console":
            for command, right in _commands(text):
                yield Ran(
                    command,
                    right.replace(PORT, port),
                    _printed(command.replace(PORT, port), folder),
                )


def _commands(text: str) -> Iterator[tuple[str, str]]:
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, _, right = part.partition("\n")
        yield command, right


def _printed(command: str, folder: Path) -> str:
    programs = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=os.environ | {"PATH": programs, "COLUMNS": "100"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=SECONDS,
    )
    return done.stdout
