"""Mark the tests that open a pseudo-terminal, which Windows lacks: ``pytest -m "not pty"``.

The mark comes from the source: a test has it if its module, or a helper that the module imports,
names a server on a pty or a module of POSIX terminals, or if one of its fixtures does.
"""

from __future__ import annotations

import os
import re
from functools import lru_cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parent
# Modules that Windows lacks, and the names of ours that need them.
USES = re.compile(
    r"^\s*(?:import|from) (?:fcntl|pty|resource|termios|tty)\b|\bopenpty\b|\bPtyServer\(",
    re.MULTILINE,
)
IMPORTS = re.compile(r"^\s*(?:from|import) ([\w.]+)(?: import \(?([\w, \n]+))?", re.MULTILINE)
# The fixtures of conftest.py that open a pty.
FIXTURES = {"arm", "server"}


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark a test that needs a pty."""
    names = set(getattr(item, "fixturenames", ()))
    if names & FIXTURES or needs_pty(item.path):
        item.add_marker("pty")


def pytest_ignore_collect(collection_path: Path) -> bool | None:
    """Skip what cannot even be imported without a pty."""
    absent = not hasattr(os, "openpty")
    return (
        True if absent and collection_path.suffix == ".py" and needs_pty(collection_path) else None
    )


@lru_cache
def needs_pty(path: Path) -> bool:
    """Return whether a module of the tests, or one that it imports, uses a pty."""
    if path.name == "conftest.py":
        return False
    text = path.read_text(encoding="utf-8")
    return bool(USES.search(text)) or any(map(needs_pty, _helpers(text)))


def _helpers(text: str) -> list[Path]:
    """Return the modules of the tests that a text imports."""
    found = []
    for module, names in IMPORTS.findall(text):
        base = ROOT / module.replace(".", "/")
        inside = [base / f"{name.strip()}.py" for name in names.split(",")]
        found += [path for path in (base.with_suffix(".py"), *inside) if path.is_file()]
    return found
