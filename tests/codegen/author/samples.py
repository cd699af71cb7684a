"""Copy the sample protocols, and run the command line on the copies."""

from __future__ import annotations

import shutil
from pathlib import Path

import in_process
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.cli import main
from cobotwire_codegen.errors import Problem, SpecError
from in_process import Ended

FOLDER = Path(__file__).parent / "samples"
EDITIONS = ("lamp.yaml", "lamp2.yaml", "bus.yaml", "bus2.yaml")


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


def run(folder: Path, *words: str, given: str | bytes = b"") -> Ended:
    """Call ``cobotwire-gen`` in a folder, without a terminal."""
    data = given.encode() if isinstance(given, str) else given
    return in_process.run(main, "cobotwire-gen", *words, given=data, folder=folder)
