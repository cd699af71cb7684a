"""Reads ``unconfirmed.yaml``: the facts without a second source, each with the reason."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, load
from spec_mutants.spec_files import ROOT


class Unconfirmed(NamedTuple):
    """A row of the list: a pattern of facts, the editions (empty: all), and the reason."""

    facts: str
    editions: tuple[str, ...]
    why: str


@lru_cache(maxsize=1)
def unconfirmed() -> tuple[Unconfirmed, ...]:
    """Return the rows of the list."""
    root = load(ROOT / "tests" / "spec_mutants" / "unconfirmed.yaml")
    assert isinstance(root, Mapping)
    return tuple(
        Unconfirmed(
            _words(row.entries["facts"])[0],
            _words(row.entries["editions"]) if "editions" in row.entries else (),
            _words(row.entries["why"])[0],
        )
        for row in _items(root.entries["unconfirmed"])
        if isinstance(row, Mapping)
    )


def accepted(edition: str, kind: str, title: str) -> str:
    """Return why a mutant may survive; empty if it may not."""
    for row in unconfirmed():
        named = not row.editions or edition in row.editions
        if named and re.fullmatch(row.facts, f"{kind} {title}"):
            return row.why
    return ""


def _items(node: Node) -> tuple[Node, ...]:
    return node.items if isinstance(node, Sequence) else (node,)


def _words(node: Node) -> tuple[str, ...]:
    return tuple(str(each.value) for each in _items(node) if isinstance(each, Scalar))
