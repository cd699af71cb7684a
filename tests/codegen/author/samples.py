"""Copy the sample protocols, and run the command line on the copies."""

from __future__ import annotations

import shutil
from fractions import Fraction
from pathlib import Path
from typing import Any

import in_process
from cobotwire_codegen.check import checked_edition
from cobotwire_codegen.cli import main
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.load import Mapping, Node, Sequence
from in_process import Ended

FOLDER = Path(__file__).parent / "samples"
EDITIONS = ("lamp.yaml", "lamp2.yaml", "bus.yaml", "bus2.yaml")


def copied(to: Path) -> Path:
    """Copy the samples, so that a test may change them."""
    return Path(shutil.copytree(FOLDER, to / "samples"))


def problems(path: Path) -> list[Problem]:
    """Return every problem of an edition."""
    try:
        checked_edition(path, path.parent)
    except SpecError as error:
        return list(error.problems)
    return []


def run(folder: Path, *words: str, given: str | bytes = b"") -> Ended:
    """Call ``cobotwire-gen`` in a folder, without a terminal."""
    data = given.encode() if isinstance(given, str) else given
    return in_process.run(main, "cobotwire-gen", *words, given=data, folder=folder)


def plain(node: Node) -> Any:
    """Return a node as the data that an editor's validator sees."""
    if isinstance(node, Mapping):
        return {key: plain(value) for key, value in node.entries.items()}
    if isinstance(node, Sequence):
        return [plain(item) for item in node.items]
    value = node.value
    return float(value) if isinstance(value, Fraction) else value
