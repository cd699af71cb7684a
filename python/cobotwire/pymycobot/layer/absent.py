"""Says why a name of the maker's class has no counterpart."""

from __future__ import annotations

import json
from functools import lru_cache
from pkgutil import get_data

# The names that no class of ours has.
_ALL = "*"


def why_absent(kind: type, name: str) -> str:
    """Return why a class has no counterpart of a name; empty if the maker has no such name."""
    if name.startswith("_"):
        return ""
    reasons = (absent(each).get(name, "") for each in [*_names(kind), _ALL])
    return next(filter(None, reasons), "")


def absent(kind: str) -> dict[str, str]:
    """Return the names that a class lacks, with why; given ``*``, those that all classes lack."""
    return _reasons().get(kind, {})


def _names(kind: type) -> list[str]:
    return [base.__name__ for base in kind.__mro__]


@lru_cache
def _reasons() -> dict[str, dict[str, str]]:
    # A program may have imported this package under the name of the library, without its folder.
    data = get_data("cobotwire", "pymycobot/absent.json")
    assert data is not None, "the loader of the package reads files"
    found: dict[str, dict[str, str]] = json.loads(data)
    return found
