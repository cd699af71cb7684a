"""YAML to plain values that know their place. The only importer of the YAML library, an extra."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.errors import ScenarioError, UsageError


class Place(NamedTuple):
    """Where something stands; lines and columns count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return ":".join(map(str, self))


class Node(NamedTuple):
    """A value and its place. Mappings hold nodes by key, lists hold nodes.

    ``keys`` says where each key of a mapping stands.
    """

    place: Place
    value: Any
    keys: dict[str, Place]


def parse(text: str, name: str) -> Node:
    """Read one YAML document; ``name`` stands for the file in messages.

    Raises:
        ScenarioError: it is no YAML, or gives a key twice.
        UsageError: the YAML library is not installed.
    """
    try:
        from ruamel.yaml import YAML
        from ruamel.yaml.error import MarkedYAMLError, YAMLError
    except ImportError:
        needed = "used where the extra is installed: pip install 'cobotwire[sim]'"
        raise UsageError("scenario file", name, needed) from None
    try:
        # The round-trip reader keeps places, and makes no object that a tag names.
        return _node(YAML(typ="rt").load(text), Place(name, 1, 1), 0)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = Place(name, mark.line + 1, mark.column + 1) if mark else Place(name, 1, 1)
        raise ScenarioError([f"{place}: {_sentence(error.problem)}"]) from None
    except (YAMLError, ValueError, RecursionError) as error:
        raise ScenarioError([f"{Place(name, 1, 1)}: no YAML: {_sentence(str(error))}"]) from None


# A scenario is a mapping with a list of mappings that hold lists; an alias may name what it is in.
_DEEPEST = 5


def _node(value: Any, place: Place, depth: int) -> Node:
    marks: Any = getattr(value, "lc", None)
    if isinstance(value, dict) and depth < _DEEPEST:
        keys, entries = {}, {}
        for key, inner in value.items():
            own = marks is not None and key in (marks.data or {})
            keys[str(key)] = _at(place, marks.key(key)) if own else place
            entries[str(key)] = _node(
                inner, _at(place, marks.value(key)) if own else place, depth + 1
            )
        return Node(place, entries, keys)
    if isinstance(value, list) and depth < _DEEPEST:
        items = [_node(item, _at(place, marks.item(n)), depth + 1) for n, item in enumerate(value)]
        return Node(place, items, {})
    return Node(place, value, {})


def _at(place: Place, mark: tuple[int, int]) -> Place:
    return Place(place.file, mark[0] + 1, mark[1] + 1)


def _sentence(text: str | None) -> str:
    return " ".join((text or "not YAML").split())
