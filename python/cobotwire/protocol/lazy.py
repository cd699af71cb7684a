"""Import each part of a generated package when one of its names is first used."""

from __future__ import annotations

import sys
from importlib import import_module

from cobotwire.protocol.light import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import Any


def lazy_names(
    package: str, named: Mapping[str, Sequence[str]], searched: Sequence[str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` for a package.

    A program uses few of an edition's commands, and a delta edition uses few classes of its base.
    Neither should import the rest.

    Args:
        package: the full name of the package.
        named: for each module, the names that it is known to define.
        searched: the modules to search, in this order, for any other name; they are also
            attributes of the package.
    """
    homes = {name: module for module, names in named.items() for name in names}
    parts = {module.rpartition(".")[2]: module for module in searched}

    def find(name: str) -> Any:
        if name in parts:
            return import_module(parts[name], package)
        for module in [homes[name]] if name in homes else searched:
            found = getattr(import_module(module, package), name, None)
            if found is not None:
                return found
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    def get(name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        found = find(name)
        setattr(sys.modules[package], name, found)
        return found

    def names() -> list[str]:
        modules = (import_module(module, package) for module in searched)
        public = (name for module in modules for name in dir(module) if name[:1].isupper())
        return sorted({*homes, *public, *vars(sys.modules[package])})

    return get, names
