"""Copies trees of nodes with one node replaced or removed."""

from __future__ import annotations

from dataclasses import replace

from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence

Path = tuple[str | int, ...]


def changed(root: Node, path: Path, new: Node | None) -> Node:
    """Return a tree with another node at ``path``; None removes the node."""
    step, rest = path[0], path[1:]
    if isinstance(root, Mapping) and isinstance(step, str):
        entries = dict(root.entries)
        if rest:
            entries[step] = changed(entries[step], rest, new)
        elif new is None:
            del entries[step]
        else:
            entries[step] = new
        return replace(root, entries=entries)
    assert isinstance(root, Sequence)
    assert isinstance(step, int)
    items = list(root.items)
    if rest:
        items[step] = changed(items[step], rest, new)
    elif new is None:
        del items[step]
    else:
        items[step] = new
    return replace(root, items=tuple(items))


def with_key(root: Mapping, old: str, new: str) -> Mapping:
    """Return a mapping with another name for one of its keys."""
    entries = {new if name == old else name: node for name, node in root.entries.items()}
    keys = {new if name == old else name: place for name, place in root.keys.items()}
    return replace(root, entries=entries, keys=keys)


def with_value(node: Scalar, value: str | int | bool) -> Scalar:
    """Return a plain value in the place of another."""
    return replace(node, value=value)
