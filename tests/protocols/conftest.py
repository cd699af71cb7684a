"""Generate the packages of the protocols once, and import them."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import render_python

HERE = Path(__file__).parent


def edition_of(name: str) -> Edition:
    """Return a protocol's edition, checked."""
    edition = build_edition(HERE / f"{name}.yaml", HERE)
    check(edition)
    return edition


@pytest.fixture(scope="session")
def package(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[str], Any]]:
    """Return a function that generates a protocol's package and imports it."""
    folder = tmp_path_factory.mktemp("protocols")
    sys.path.insert(0, str(folder))

    def make(name: str) -> Any:
        if not (folder / f"protocol_{name}").exists():
            write(Target(folder / f"protocol_{name}", render_python(edition_of(name))))
            importlib.invalidate_caches()
        return importlib.import_module(f"protocol_{name}")

    yield make
    sys.path.remove(str(folder))
