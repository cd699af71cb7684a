"""Finds the facts of a spec file, and replaces them.

The description of the spec language says which keys state facts, so it covers new keys too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from cobotwire_codegen import language
from cobotwire_codegen.language.changes import CHANGE
from cobotwire_codegen.language.effects import ByCase, Computes, Lists, Moves
from cobotwire_codegen.language.messages import SelectedReplyField
from cobotwire_codegen.language.records import (
    Changed,
    Choice,
    Described,
    InFile,
    InFiles,
    Key,
    Listed,
    ListedTwice,
    Named,
    Part,
)
from cobotwire_codegen.language.shapes import Known, Lines, Shape, Text, Texts
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence

Path = tuple[str | int, ...]

# The texts and names that state facts.
STATED = {
    language.RequestText.text,
    language.Frame.length_counts,
    language.Command.alias,
    language.SelectedRequestField.selector,
    SelectedReplyField.selector,
    *(Moves.by, Moves.about, Moves.direction, Moves.speed),
    *(Lists.list, Lists.append, Computes.from_, Computes.near, ByCase.selector),
}
# These are not facts: names of other files, and the lines that facts are compared with.
BESIDE = (InFile, InFiles, Lines)
DEFINITIONS = {language.Command, *language.SECTIONS.values()}
EVIDENCE = {language.Dispute, language.Evidence}


class Fact(NamedTuple):
    """A node that states a fact: its place, its kind, and whether it is optional."""

    path: Path
    kind: str
    node: Node
    shape: Shape[Any] | None
    removable: bool


def facts_of(root: Node) -> Iterator[Fact]:
    """Yield the facts of a file."""
    assert isinstance(root, Mapping)
    described = next(record for key, record in language.FILES.items() if key in root.entries)
    yield from _mapping(root, described, ())


def _mapping(node: Node, described: Described, path: Path) -> Iterator[Fact]:
    if not isinstance(node, Mapping):
        return
    record = described.of(node) if isinstance(described, Choice) else described
    verbs = CHANGE.chosen if record in CHANGE.options() else {}
    for name, child in node.entries.items():
        key = record.keys().get(name)
        if key is not None and name not in verbs:
            yield from _key(record.definition(), key, child, (*path, name))


def _key(owner: str, key: Key[Any], node: Node, path: Path) -> Iterator[Fact]:
    text = isinstance(key.shape, Text | Texts | Lines) and not isinstance(key.shape, Known)
    beside = isinstance(key.shape, BESIDE) or EVIDENCE & {*key.shape.records}
    if beside or (text and key not in STATED):
        return
    yield Fact(path, f"{owner}.{key.name}", node, key.shape, not key.required)
    yield from _inside(key.shape, node, path, f"{owner}.{key.name}")


def _inside(shape: Shape[Any], node: Node, path: Path, kind: str) -> Iterator[Fact]:
    """Yield the facts inside the value of a key."""
    if isinstance(shape, Part):
        yield from _mapping(node, shape.records[0], path)
    elif isinstance(shape, Listed | ListedTwice) and isinstance(node, Sequence):
        for index, item in enumerate(node.items):
            at = (*path, index)
            yield Fact(at, f"{kind} (one)", item, None, removable=True)
            if isinstance(item, Sequence):
                for inner, part in enumerate(item.items):
                    yield Fact((*at, inner), f"{kind} (field)", part, None, removable=True)
                    yield from _mapping(part, shape.records[0], (*at, inner))
            else:
                yield from _mapping(item, shape.records[0], at)
    elif isinstance(shape, Named) and isinstance(node, Mapping):
        content = shape.content
        for name, item in node.entries.items():
            at = (*path, name)
            inner_shape = content if isinstance(content, Shape) else None
            if content not in DEFINITIONS:
                yield Fact(at, kind, item, inner_shape, removable=True)
            if not isinstance(content, Shape):
                yield from _mapping(item, content, at)
    elif isinstance(shape, Changed) and isinstance(node, Mapping):
        for name, item in node.entries.items():
            key = shape.keys().get(name)
            if key is not None:
                yield from _key(kind.rpartition(".")[0], key, item, (*path, name))


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
