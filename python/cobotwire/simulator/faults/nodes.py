"""Read YAML into plain values that know their place. The only importer of the YAML library."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cobotwire.protocol.errors import ScenarioError, UsageError


class Place(NamedTuple):
    """A place in a file; lines and columns count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return ":".join(map(str, self))


class Node(NamedTuple):
    """A value and its place. Mappings contain nodes by key, lists contain nodes.

    ``keys`` has the place of each key of a mapping.
    """

    place: Place
    value: Any
    keys: dict[str, Place]


def parse(text: str, name: str) -> Node:
    """Read one YAML document; messages call the file ``name``.

    Raises:
        ScenarioError: the text is not YAML, has a key twice, or contains a tag.
        UsageError: the YAML library is not installed.
    """
    try:
        from ruamel.yaml import YAML
        from ruamel.yaml.error import MarkedYAMLError, YAMLError
    except ImportError:
        message = "fault scenarios need ruamel.yaml: pip install 'cobotwire[sim]'"
        raise UsageError("scenario", message=message) from None
    yaml = YAML(typ="safe", pure=True)
    try:
        # Only nodes and single scalars are read, so that no tag can construct an object.
        reading = _Reading(name, yaml.constructor.construct_object)
        root = reading.node(yaml.compose(text), 0)
    except MarkedYAMLError as error:
        place = _after(Place(name, 1, 1), error.problem_mark or error.context_mark)
        raise ScenarioError([f"{place}: {_sentence(error.problem)}"]) from None
    except (YAMLError, RecursionError) as error:
        place = _place_in(text, name, getattr(error, "position", 0))
        raise ScenarioError([f"{place}: not YAML: {_sentence(str(error))}"]) from None
    if reading.problems:
        problems = sorted(reading.problems)
        raise ScenarioError([f"{place}: {message}" for place, message in problems])
    return root


# A scenario is a mapping with a list of mappings of lists; an alias may contain itself.
_DEEPEST = 5
_TAG = "tag:yaml.org,2002:"
_PLAIN = ("str", "int", "float", "bool", "null")


class _Reading:
    """Converts the library's nodes; ``scalar`` returns the value of one of its scalars."""

    def __init__(self, name: str, scalar: Callable[[Any], Any]) -> None:
        self.problems: set[tuple[Place, str]] = set()
        self._top = Place(name, 1, 1)
        self._scalar = scalar
        self._made: dict[tuple[int, int], Node] = {}

    def node(self, found: Any, depth: int) -> Node:
        """Convert a node, and all nodes in it."""
        if found is None:
            return Node(self._top, None, {})
        # Convert it once, however many aliases it has: a small file can have a billion of them.
        made = self._made.get((id(found), depth))
        if made is None:
            made = self._made[id(found), depth] = self._make(found, depth)
        return made

    def _make(self, found: Any, depth: int) -> Node:
        place = _after(self._top, found.start_mark)
        kind = str(found.tag).removeprefix(_TAG)
        if kind == "map" and found.id == "mapping" and depth < _DEEPEST:
            return self._mapping(found, place, depth)
        if kind == "seq" and found.id == "sequence" and depth < _DEEPEST:
            return Node(place, [self.node(item, depth + 1) for item in found.value], {})
        if kind in _PLAIN and found.id == "scalar":
            return Node(place, self._value(found, place), {})
        what = (
            "this is nested too deeply"
            if depth >= _DEEPEST
            else f"the tag {found.tag} is not allowed"
        )
        self.problems.add((place, what))
        return Node(place, None, {})

    def _mapping(self, found: Any, place: Place, depth: int) -> Node:
        entries: dict[str, Node] = {}
        keys: dict[str, Place] = {}
        for key, inner in found.value:
            at = _after(self._top, key.start_mark)
            if key.id != "scalar":
                self.problems.add((at, "a key must be a plain word"))
            elif key.value in entries:
                first = keys[key.value].line
                self.problems.add((at, f"the key {key.value} is already in line {first}"))
            else:
                keys[key.value] = at
                entries[key.value] = self.node(inner, depth + 1)
        return Node(place, entries, keys)

    def _value(self, found: Any, place: Place) -> Any:
        try:
            return self._scalar(found)
        except (ValueError, KeyError):
            self.problems.add((place, "this does not match its tag, or has too many digits"))
            return None


def _after(top: Place, mark: Any) -> Place:
    return top if mark is None else Place(top.file, mark.line + 1, mark.column + 1)


def _place_in(text: str, name: str, position: int) -> Place:
    lines = text[:position].split("\n")
    return Place(name, len(lines), len(lines[-1]) + 1)


def _sentence(text: str | None) -> str:
    return " ".join((text or "not YAML").split())
