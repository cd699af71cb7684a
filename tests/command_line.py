"""Run the command line in another process."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cobotwire

PROGRAM = [sys.executable, "-c", "from cobotwire.cli import main; main()"]


def run_program(*words: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the command line with these words and further environment variables."""
    return subprocess.run(
        [*PROGRAM, *map(str, words)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env={**os.environ, **environment},
    )


@contextmanager
def started(*words: str | Path, first: str = "") -> Iterator[subprocess.Popen[str]]:
    """Start the command line after other statements; kill it at the end, if it still runs."""
    command = [sys.executable, "-c", f"{first}\n{PROGRAM[2]}", *map(str, words)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def printed(process: subprocess.Popen[str]) -> str:
    """Return the next line that a program prints."""
    assert process.stdout is not None
    return process.stdout.readline()


def run_code(code: str) -> subprocess.CompletedProcess[str]:
    """Run code without installed packages, some of which import modules when Python starts."""
    return subprocess.run(
        [sys.executable, "-S", "-c", code],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env={**os.environ, "PYTHONPATH": str(Path(cobotwire.__file__).parents[1])},
    )
