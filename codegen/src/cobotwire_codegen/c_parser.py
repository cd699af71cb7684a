"""Parses plain YAML in C, which is faster; the parser in Python parses all other text.

The C parser is optional. It follows YAML 1.1 and has other messages. So its result is used only for
text that both parsers read alike: one document, a mapping or a list, without mistakes, directives,
anchors, aliases and tags, in which each empty value has quotes. ``tests/codegen/test_c_parser.py``
compares both parsers.
"""

from __future__ import annotations

import re
from functools import cache, lru_cache
from importlib import import_module
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import (
    DocumentStartEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
    StreamEndEvent,
    StreamStartEvent,
)
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.tag import Tag

c_library: Any
try:
    c_library = import_module("_ruamel_yaml")
except ImportError:
    c_library = None

# Text that the C parser reads differently: tabs, byte order marks, line breaks of YAML 1.1, a
# comment right after | or >.
_READ_DIFFERENTLY = re.compile(r"[\t\ufeff\x85\u2028\u2029]|[|>][-+0-9]*#")
_RESOLVER = YAML(typ="safe", pure=True).resolver
_TAG = "tag:yaml.org,2002:"
# Nodes share these tags: a tag caches its text, which takes long to make.
_SEQUENCE, _MAPPING = Tag(suffix=f"{_TAG}seq"), Tag(suffix=f"{_TAG}map")


class _Unsure(Exception):
    """Only the parser in Python can validate the text."""


def plain_root(text: str, deepest: int) -> Node | None:
    """Return the root node of plain YAML text that is nested at most ``deepest`` deep.

    Nodes have no end marks. Return None if the parser in Python must read the text: it knows the
    rest of YAML, checks the limits and reports mistakes.
    """
    if c_library is None or _READ_DIFFERENTLY.search(text):
        return None
    try:
        return _Composer(c_library.CParser(text), deepest).root()
    except (YAMLError, UnicodeError, _Unsure):
        return None


class _Composer:
    """Builds nodes from the events of a parser."""

    def __init__(self, parser: Any, deepest: int) -> None:
        self._next = parser.get_event
        self._deepest = deepest

    def root(self) -> Node:
        """Return the root node of the only document."""
        self._expect(StreamStartEvent)
        start = self._expect(DocumentStartEvent)
        if start.version is not None or start.tags:
            raise _Unsure
        root = self._node(self._next(), 1)
        self._next()
        self._expect(StreamEndEvent)
        if isinstance(root, ScalarNode):
            raise _Unsure
        return root

    def _expect(self, kind: type) -> Any:
        event = self._next()
        if not isinstance(event, kind):
            raise _Unsure
        return event

    def _node(self, event: Any, depth: int) -> Node:
        if getattr(event, "anchor", None) or getattr(event, "tag", None) or depth > self._deepest:
            raise _Unsure
        mark = event.start_mark
        if isinstance(event, ScalarEvent):
            if event.value == "" and event.style not in ("'", '"'):
                raise _Unsure
            return ScalarNode(_scalar_tag(event.value, event.implicit), event.value, mark)
        if isinstance(event, SequenceStartEvent):
            return SequenceNode(_SEQUENCE, self._items(depth), mark)
        if isinstance(event, MappingStartEvent):
            return MappingNode(_MAPPING, self._entries(depth), mark)
        raise _Unsure

    def _items(self, depth: int) -> list[Node]:
        items = []
        while not isinstance(event := self._next(), SequenceEndEvent):
            items.append(self._node(event, depth + 1))
        return items

    def _entries(self, depth: int) -> list[tuple[Node, Node]]:
        entries = []
        while not isinstance(event := self._next(), MappingEndEvent):
            key = self._node(event, depth + 1)
            entries.append((key, self._node(self._next(), depth + 1)))
        return entries


@lru_cache(maxsize=10_000)
def _scalar_tag(value: str, implicit: tuple[bool, bool]) -> Tag:
    """Return the tag of a scalar by the rules of YAML 1.2."""
    return _tag(str(_RESOLVER.resolve(ScalarNode, value, implicit)))


@cache
def _tag(text: str) -> Tag:
    return Tag(suffix=text)
