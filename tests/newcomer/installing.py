"""Run the programs of an installation."""

from __future__ import annotations

import subprocess
from pathlib import Path


def run(
    *words: str | Path, cwd: Path | None = None, env: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(word) for word in words],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
        cwd=cwd,
        env=env,
    )
