"""Read YAML into plain values that know their place. The only importer of the YAML library."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cobotwire.protocol.errors import ScenarioError, StatementError, UsageError


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


def parse(
    text: str,
    name: str,
    what: str = "fault scenarios",
    failed: type[ScenarioError | StatementError] = ScenarioError,
) -> Node:
    """Read one YAML document; messages call the file ``name``, and files of its kind ``what``.

    Raises:
        ScenarioError: the text is not YAML, has a key twice, contains a tag, or exceeds a limit.
            If ``failed`` is another class, that class is raised.
        UsageError: the YAML library is not installed.
    """
    try:
        from ruamel.yaml import YAML
        from ruamel.yaml.error import MarkedYAMLError, YAMLError
    except ImportError:
        message = f"{what} need ruamel.yaml: pip install 'cobotwire[sim]'"
        raise UsageError("scenario", message=message) from None
    if len(text) > MOST_CHARACTERS:
        message = f"the file has more than {MOST_CHARACTERS} characters, the limit"
        raise failed([f"{Place(name, 1, 1)}: {message}"])
    yaml = YAML(typ="safe", pure=True)
    # The later anchor counts, as YAML says; no warning is needed.
    yaml.composer.warn_double_anchors = False
    yaml.max_depth = _DEEPEST + 5  # deeper files are not parsed; the others get a better message
    try:
        # Only nodes and single scalars are read, so that no tag can construct an object.
        reading = _Reading(name, yaml.constructor.construct_object)
        root = reading.node(yaml.compose(text), 0)
    except MarkedYAMLError as error:
        place = _after(Place(name, 1, 1), error.problem_mark or error.context_mark)
        too_deep = "maximum depth" in (error.problem or "")
        message = TOO_DEEP if too_deep else _sentence(error.problem)
        raise failed([f"{place}: {message}"]) from None
    except (YAMLError, RecursionError) as error:
        place = _place_in(text, name, getattr(error, "position", 0))
        raise failed([f"{place}: not YAML: {_sentence(str(error))}"]) from None
    except ScenarioError as error:
        # Reading ended at the limit of a file.
        raise failed(error.problems) from None
    if reading.problems:
        problems = sorted(reading.problems)
        raise failed([f"{place}: {message}" for place, message in problems])
    return root


# The limits of a file, many times what the longest scenario needs. Each use of an alias counts:
# every use is read, and an alias may contain itself.
MOST_CHARACTERS = 1024 * 1024
MOST_NODES = 100_000
# A scenario is a mapping with a list of mappings of lists.
_DEEPEST = 5
TOO_DEEP = "this is nested too deeply"
_TAG = "tag:yaml.org,2002:"
_PLAIN = ("str", "int", "float", "bool", "null")


class _Reading:
    """Converts the library's nodes; ``scalar`` returns the value of one of its scalars."""

    def __init__(self, name: str, scalar: Callable[[Any], Any]) -> None:
        self.problems: set[tuple[Place, str]] = set()
        self._top = Place(name, 1, 1)
        self._scalar = scalar
        self._nodes = 0

    def node(self, found: Any, depth: int) -> Node:
        """Convert a node, and all nodes in it."""
        if found is None:
            return Node(self._top, None, {})
        self._nodes += 1
        if self._nodes > MOST_NODES:
            place = _after(self._top, found.start_mark)
            message = f"up to here the file has more than {MOST_NODES} values, the limit"
            raise ScenarioError([f"{place}: {message}; each use of an alias counts"])
        return self._make(found, depth)

    def _make(self, found: Any, depth: int) -> Node:
        place = _after(self._top, found.start_mark)
        kind = str(found.tag).removeprefix(_TAG)
        if kind == "map" and found.id == "mapping" and depth < _DEEPEST:
            return self._mapping(found, place, depth)
        if kind == "seq" and found.id == "sequence" and depth < _DEEPEST:
            return Node(place, [self.node(item, depth + 1) for item in found.value], {})
        if kind in _PLAIN and found.id == "scalar":
            return Node(place, self._value(found, place), {})
        what = TOO_DEEP if depth >= _DEEPEST else f"the tag {found.tag} is not allowed"
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
