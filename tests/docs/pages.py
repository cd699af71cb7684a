"""Run a page of the guide: write its files, run its commands, and compare their output.

A code block after ``<!-- file: NAME -->`` is a file; after ``append:`` it is appended to one. In a
block ``console`` each line that starts with ``$`` is a command, and the lines after it are its
expected output, where ``...`` stands for any lines. Other blocks are ignored.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Container, Iterator
from pathlib import Path
from typing import NamedTuple

BLOCK = re.compile(
    r"(?:^<!-- (?P<how>file|append): (?P<name>\S+) -->\n)?^```(?P<kind>\w+)\n(?P<text>.*?)^```$",
    re.DOTALL | re.MULTILINE,
)
# Even on a busy machine, only a command that hangs takes this long.
SECONDS = 900
PORT = "/dev/ttyACM0"
# `cobotwire doctor` reports this on a busy machine, whatever the page is about.
SLOW = re.compile(r"^- slow: a round trip takes [\d.]+ ms\n    .*\n", re.MULTILINE)
# The arm arrives within a tenth of a degree; the exact reading depends on when it is taken.
ARRIVED = re.compile(r"(?<==)-?0\.0\d?(?=\s)")


class CommandRun(NamedTuple):
    """A command of a page, its expected output, and its actual output."""

    command: str
    expected: str
    printed: str

    @property
    def matches(self) -> bool:
        """Return whether the output equals that on the page, except where it depends on times."""
        printed = ARRIVED.sub("0.0", SLOW.sub("", self.printed))
        return re.fullmatch(output_pattern(self.expected), printed) is not None


def output_pattern(shown: str) -> str:
    """Return a regular expression for the output that a page shows; ``...`` is any lines."""
    return re.escape(shown).replace(re.escape("...\n"), r"(?:.*\n)*?")


def run(page: Path, folder: Path, port: str, without: Container[str] = ()) -> Iterator[CommandRun]:
    """Run a page from top to bottom, with ``port`` in place of the port that the page names.

    Args:
        page: The page.
        folder: Where its files are written, and its commands run.
        port: The port of an arm.
        without: Commands that are not run.
    """
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        text = block["text"]
        if block["how"]:
            mode = "a" if block["how"] == "append" else "w"
            path = folder / block["name"]
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open(mode) as file:
                file.write(text.replace(PORT, port))
        elif block["kind"] == "console":
            for command, expected in _commands(text):
                if command in without:
                    continue
                yield CommandRun(
                    command,
                    expected.replace(PORT, port),
                    _printed(command.replace(PORT, port), folder),
                )


def _commands(text: str) -> Iterator[tuple[str, str]]:
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, _, expected = part.partition("\n")
        yield command, expected


def _printed(command: str, folder: Path) -> str:
    programs = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    try:
        done = subprocess.run(
            ["bash", "-c", command],
            cwd=folder,
            env=os.environ | {"PATH": programs, "COLUMNS": "100"},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=SECONDS,
        )
    except subprocess.TimeoutExpired:
        return f"(did not end within {SECONDS} s)\n"
    return done.stdout
