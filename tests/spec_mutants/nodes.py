"""Copies trees of nodes with one node replaced or removed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence

Path = tuple[str | int, ...]


def changed(root: Node, path: Path, new: Node | None) -> Node:
    """Return a tree with another node at ``path``; None removes the node."""
    if isinstance(root, Mapping):
        return replace(root, entries=_with_child(dict(root.entries), path, new))
    assert isinstance(root, Sequence)
    items = _with_child(dict(enumerate(root.items)), path, new)
    return replace(root, items=tuple(items.values()))


def _with_child(children: dict[Any, Node], path: Path, new: Node | None) -> dict[Any, Node]:
    step, rest = path[0], path[1:]
    if rest:
        children[step] = changed(children[step], rest, new)
    elif new is None:
        del children[step]
    else:
        children[step] = new
    return children


def with_key(root: Mapping, old: str, new: str) -> Mapping:
    """Return a mapping with another name for one of its keys."""
    entries = {new if name == old else name: node for name, node in root.entries.items()}
    keys = {new if name == old else name: place for name, place in root.keys.items()}
    return replace(root, entries=entries, keys=keys)


def with_value(node: Scalar, value: str | int | bool) -> Scalar:
    """Return a plain value in the place of another."""
    return replace(node, value=value)
