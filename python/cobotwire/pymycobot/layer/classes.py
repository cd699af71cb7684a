"""The classes with the maker's names; each is made when it is used. ``classes.pyi`` has types."""

from __future__ import annotations

from cobotwire.pymycobot.layer.making import class_named


def __getattr__(name: str) -> type:
    return class_named(name)
