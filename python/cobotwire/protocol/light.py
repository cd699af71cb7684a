"""What modules use to load quickly: importing a client should load neither session nor table.

``typing``, ``dataclasses``, ``re`` and ``json`` take longer to import than all of a client's code.
"""

from __future__ import annotations

# Type checkers know a variable of this name; ``typing`` itself takes as long as starting Python.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any

    from cobotwire.protocol.table import Table

# How long a motion is waited for by default.
MOTION_SECONDS = 30.0


class Later:
    """Stands for a module, which is imported when one of its names is first used."""

    def __init__(self, module: str) -> None:
        self._module = module

    def __getattr__(self, name: str) -> Any:
        from importlib import import_module

        found = getattr(import_module(self._module), name)
        # Found without this method from now on.
        self.__dict__[name] = found
        return found


class _LaterTable:
    def __init__(self, package: str) -> None:
        self._package = package

    def __set_name__(self, owner: type, name: str) -> None:
        self._owner, self._name = owner, name

    def __get__(self, client: object, of: type) -> Table:
        from importlib import import_module

        table: Table = import_module(".table", self._package).TABLE
        setattr(self._owner, self._name, table)
        return table


def later_table(package: str | None) -> Any:
    """Return what a client class holds as its table, which is loaded when it is first used."""
    assert package is not None, "a client is in the package of its edition"
    return _LaterTable(package)
