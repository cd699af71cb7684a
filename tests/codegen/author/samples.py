"""Copy the sample protocols, and run the command line on the copies."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.errors import Problem, SpecError

FOLDER = Path(__file__).parent / "samples"
EDITIONS = ("lamp.yaml", "lamp2.yaml", "bus.yaml")


def copied(to: Path) -> Path:
    """Copy the samples, so that a test may change them."""
    return Path(shutil.copytree(FOLDER, to / "samples"))


def problems(path: Path) -> list[Problem]:
    """Return every problem of an edition."""
    try:
        check(build_edition(path, path.parent))
    except SpecError as error:
        return list(error.problems)
    return []


def run(
    folder: Path, *words: str, given: str | bytes | None = None
) -> subprocess.CompletedProcess[str]:
    """Call ``cobotwire-gen`` in a folder, without a terminal."""
    data = given.encode() if isinstance(given, str) else given or b""
    command = [sys.executable, "-m", "cobotwire_codegen", *words]
    result = subprocess.run(command, cwd=folder, input=data, capture_output=True, check=False)
    return subprocess.CompletedProcess(
        command, result.returncode, result.stdout.decode(), result.stderr.decode()
    )
