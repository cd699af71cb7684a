"""The specs of tests, with every type and with frames of other makers."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import vectors
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.model import Edition

TESTS = vectors.ROOT / "tests"
FOLDERS = (TESTS / "codegen" / "families", TESTS / "protocols")
SPECS = {path.stem: path for folder in FOLDERS for path in sorted(folder.glob("*.yaml"))}


@lru_cache
def edition_of(path: Path) -> Edition:
    """Return the checked edition of a spec."""
    edition = build_edition(path, path.parent)
    check(edition)
    return edition
