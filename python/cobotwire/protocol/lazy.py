"""Import the parts of a generated package only when one of their names is asked for."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any


def lazy_names(
    package: str, named: Mapping[str, Sequence[str]], searched: Sequence[str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` for a package.

    A program uses few of an edition's commands, and a delta edition takes single classes from its
    base: neither must pay for the rest.

    Args:
        package: the full name of the package.
        named: the names that are known to be in a module, by the module.
        searched: the modules that are searched, in this order, for any other name; they are
            attributes of the package themselves.
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
