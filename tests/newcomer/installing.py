"""Run the programs of an installation."""

from __future__ import annotations

import subprocess
from pathlib import Path


def run(
    *words: str | Path, cwd: Path | None = None, env: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a program to its end. If it fails, what it printed is a note of the exception."""
    ended = subprocess.run(
        [str(word) for word in words],
        capture_output=True,
        text=True,
        timeout=300,
        cwd=cwd,
        env=env,
    )
    try:
        ended.check_returncode()
    except subprocess.CalledProcessError as error:
        error.add_note(f"it printed: {ended.stdout}{ended.stderr}")
        raise
    return ended
