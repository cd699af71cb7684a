"""Import each part of a generated package when one of its names is first used.

Calls import nothing. If Ctrl-C ended an import in the main thread, a lock of the import system
could stay held, and every thread that imports the same module would wait for ever. So a client
calls :func:`load_parts` when it opens, and the diagnosis of noise is imported by
:func:`import_aside`.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any

# The modules of each package that :func:`lazy_names` was called for.
_parts: dict[str, tuple[str, ...]] = {}


def load_parts(package: str) -> None:
    """Import a package and all parts that its names can come from."""
    import_module(package)
    for part in _parts.get(package, ()):
        import_module(part, package)


def import_aside(module: str, *names: str) -> None:
    """Import a module, and the parts of it that define ``names``, in a thread of its own.

    Ctrl-C reaches only the main thread, so it cannot end this import half-way. An ``import``
    statement after this call finds the module loaded, or raises what the import raises.
    """
    loaded = vars(sys.modules.get(module, object)).keys()
    if module in sys.modules and loaded >= set(names):
        return

    def load() -> None:
        with suppress(Exception):
            found = import_module(module)
            for name in names:
                getattr(found, name)

    thread = threading.Thread(target=load, name=f"import of {module}")
    try:
        thread.start()
    except RuntimeError:
        # The interpreter ends, or has no more threads.
        return
    thread.join()


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
    _parts[package] = tuple(searched)
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
