"""Run a command line in this process: to start another takes longer than most tests."""

from __future__ import annotations

from contextlib import chdir
from pathlib import Path
from typing import NamedTuple

import click
from click.testing import CliRunner

from cobotwire.cli.app import app


class Ended(NamedTuple):
    """How a program ended, with the attributes of a ``CompletedProcess``."""

    returncode: int
    stdout: str
    stderr: str


def run(
    command: click.Command,
    program: str,
    *words: str,
    given: bytes = b"",
    folder: Path | None = None,
) -> Ended:
    """Run a command as a program of that name, in a folder, with the given standard input.

    An exception that would end a program with a traceback is raised.
    """
    with chdir(folder or Path.cwd()):
        done = CliRunner(catch_exceptions=False).invoke(
            command, words, input=given, prog_name=program
        )
    return Ended(done.exit_code, done.stdout, done.stderr)


def cobotwire(*words: str | Path, given: bytes = b"") -> Ended:
    """Run the command line of the package."""
    return run(app, "cobotwire", *map(str, words), given=given)
