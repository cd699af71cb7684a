"""Reads what the generator states about the library's classes, each in a file of ``data``."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from cobotwire.pymycobot.layer.calling import Method
from cobotwire.pymycobot.layer.data import NAMES

Row = dict[str, Any]


def class_row(name: str) -> Row:
    """Return what is stated about a class.

    Raises:
        AttributeError: there is no such class.
    """
    if name not in NAMES:
        raise AttributeError(f"the layer has no class {name!r}", name=name)
    found: Row = _file(name.lower()).CLASS
    return found


def methods(row: Row) -> list[Method]:
    """Return the methods that are stated for a class; some are in the files of other classes."""
    rows = (method for file in row.get("methods_in", ()) for method in _file(file).METHODS)
    return [Method(*rest) for kinds, *rest in rows if row["name"] in kinds]


def _file(name: str) -> Any:
    return import_module(f"cobotwire.pymycobot.layer.data.{name}")
