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


def with_value(node: Scalar, value: str | int | bool) -> Scalar:
    """Return a plain value in the place of another."""
    return replace(node, value=value)
