"""The editions of the protocol: one generated package each, found by name."""

from __future__ import annotations

from difflib import get_close_matches
from importlib import import_module
from pkgutil import iter_modules
from typing import Protocol, cast

from cobotwire.driver import Driver
from cobotwire.errors import UsageError
from cobotwire.table import Table

DEFAULT = "mycobot"


class Edition(Protocol):
    """What an edition's package holds."""

    TABLE: Table
    CLIENT: type[Driver]


def names() -> list[str]:
    """The editions that come with cobotwire."""
    return sorted(module.name for module in iter_modules(__path__) if module.ispkg)


def load(name: str = DEFAULT) -> Edition:
    """The edition called ``name``.

    Raises:
        UsageError: there is no such edition.
    """
    if name not in names():
        near = get_close_matches(name, names(), n=1)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise UsageError("edition", name, f"one of {', '.join(names())}{hint}")
    return cast(Edition, import_module(f"cobotwire.editions.{name}"))
