"""Finds what the language of the spec allows at a position of a text.

The text is being edited, so it is usually not valid YAML. The position is found by indentation and
by the open brackets of its line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from cobotwire_codegen.language.edition import EDITION, FILES
from cobotwire_codegen.language.records import Changed, Choice, Described, Key, Named
from cobotwire_codegen.language.shapes import Shape

_START = re.compile(r"\s*(?P<dash>-\s+)?(?:-\s+)*")
_KEY = re.compile(_START.pattern + r"(?P<key>[\w-]+)\s*:(?:\s|$)")
_INNER = re.compile(r"""([{[,}\]])|([\w-]+)\s*:(?=\s|$)|("[^"]*"|'[^']*')""")


@dataclass(frozen=True, slots=True)
class Context:
    """What is allowed at a position.

    ``keys`` are the keys of the mapping there; if ``value_of`` is set, the position is after the
    colon of that key.
    """

    keys: Mapping[str, Key[Any]]
    value_of: str = ""

    @property
    def shape(self) -> Shape[Any] | None:
        """The shape of the value at the position; None if the position is at a key."""
        key = self.keys.get(self.value_of)
        return key.shape if key is not None else None


def context_at(text: str, line: int, column: int) -> Context:
    """Return what is allowed at a position; lines and columns count from 0."""
    lines = text.split("\n")
    before = lines[line][:column] if line < len(lines) else ""
    path = _block_path(lines, line, before)
    inner, value_of = _inner_path(before)
    return Context(_descend(_root(text), [*path, *inner]), value_of)


def _root(text: str) -> Described:
    kinds = [kind for kind in FILES if re.search(rf"(?m)^{kind}:", text)]
    return FILES[kinds[0]] if kinds else EDITION


def _block_path(lines: list[str], line: int, before: str) -> list[str]:
    """Return the keys in the lines above a position that contain it, outermost first."""
    path: list[str] = []
    start = _START.match(before)
    assert start is not None, "the pattern matches any text"
    # A key left of this column contains the position. A list may be indented like its key: if a
    # dash is at this column, a key at the same column contains the position, too.
    column, listed = start.end(), start["dash"] is not None
    column = start.start("dash") if listed else column
    for above in reversed(lines[:line]):
        found = _KEY.match(above)
        if found is None:
            continue
        at, dash = found.start("key"), found.start("dash")
        contains = at < column or (listed and at == column)
        if contains:
            path.append(found["key"])
        if contains or (at == column and not listed):
            column, listed = (dash, True) if dash >= 0 else (at, False)
    return path[::-1]


def _inner_path(before: str) -> tuple[list[str], str]:
    """Return the keys opened on the line before the position, and the key of the value there."""
    opened: list[str] = []
    key = ""
    for bracket, name, _ in _INNER.findall(re.sub(r"^\s*(?:-\s+)*", "", before)):
        if name:
            key = name
        elif bracket in ("{", "["):
            opened.append(key)
            key = ""
        elif bracket in ("}", "]"):
            key = opened.pop() if opened else ""
        elif bracket == ",":
            key = ""
    return [name for name in opened if name], key


Level = Mapping[str, Key[Any]] | Named


def _descend(root: Described, path: list[str]) -> Mapping[str, Key[Any]]:
    """Return the keys of the mapping at a path.

    If a place can hold one of several records, return the keys of all: the key that selects the
    record may not be written yet.
    """
    levels: list[Level] = [*_records(root)]
    for step in path:
        levels = [inner for level in levels for inner in _inside(level, step)]
    known = [level for level in levels if not isinstance(level, Named)]
    return {name: key for level in reversed(known) for name, key in level.items()}


def _inside(level: Level, step: str) -> Iterator[Level]:
    """Yield what the value of a key, or of a name, can be."""
    if isinstance(level, Named):
        yield from (keys for record in level.records for keys in _records(record))
        return
    shape = level[step].shape if step in level else None
    if isinstance(shape, Named):
        yield shape
    elif isinstance(shape, Changed):
        yield shape.keys()
    elif shape is not None:
        yield from (keys for record in shape.records for keys in _records(record))


def _records(described: Described) -> Iterator[Mapping[str, Key[Any]]]:
    if isinstance(described, Choice):
        yield from (keys for option in described.options() for keys in _records(option))
    else:
        yield described.keys()
