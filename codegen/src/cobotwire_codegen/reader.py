"""Reads one mapping of the spec by its description, and reports problems.

A reader does not stop at the first problem: it records the problem and returns a harmless stand-in,
so that one run reports every problem.
"""

from __future__ import annotations

from typing import Any, TypeVar

from cobotwire_codegen.errors import Place, Problem, nearest
from cobotwire_codegen.language.records import Choice, Described, Key
from cobotwire_codegen.language.shapes import KIND
from cobotwire_codegen.load import Mapping, Node, Scalar

T = TypeVar("T")


class Reader:
    """Reads one mapping of the spec. Checks its keys at once, and its values when they are read.

    ``what`` names the mapping in messages: "the command send_angle".
    """

    def __init__(
        self, node: Node, described: Described, what: str, problems: list[Problem]
    ) -> None:
        self.place = node.place
        self.record = described.of(node) if isinstance(described, Choice) else described
        self.what = what
        self.problems = problems
        self._node = node if isinstance(node, Mapping) else Mapping(node.place, {})
        if isinstance(node, Mapping):
            self._compare_keys()
        else:
            self.problem("wrong-kind", f"{what} is {KIND[type(node)]}, but must be a mapping")

    def _compare_keys(self) -> None:
        keys = self.record.keys()
        for name in self._node.entries:
            if name not in keys and name in self.record.LIMITS:
                self.problem("cannot-say", self.record.LIMITS[name], self._node.keys[name])
            elif name not in keys:
                message = f"{self.what} has no key {name}{nearest(name, keys)}"
                self.problem("unknown-key", message, self._node.keys[name])
        for name, key in keys.items():
            if key.required and name not in self._node.entries:
                hint = f"; {self.record.LIMITS[name]}" if name in self.record.LIMITS else ""
                self.problem(key.absent, f"{self.what} lacks the key {name}{hint}")

    def problem(self, code: str, message: str, place: Place | None = None) -> None:
        """Record a problem."""
        self.problems.append(Problem(place or self.place, code, message))

    def get(self, key: Key[T]) -> T:
        """Return the value of a key, or its default if the key is left out."""
        assert key.name in self.record.keys(), f"{self.record.__name__} describes no {key.name}"  # noqa: SIM118
        node = self.node(key)
        if node is None:
            return key.default
        return key.shape.read(node, f"{key.name} of {self.what}", self.problem)

    def node(self, key: Key[Any]) -> Node | None:
        """Return the node of a key, or None if the key is left out."""
        return self._node.entries.get(key.name)

    def place_of(self, key: Key[Any]) -> Place:
        """Return the place of a key's value, or of the mapping if the key is left out."""
        node = self.node(key)
        return self.place if node is None else node.place


def chosen(node: Node, choice: Choice, what: str, problems: list[Problem]) -> str | None:
    """Return the key that decides the kind of a change.

    Report a problem if there is not exactly one such key.
    """
    if not isinstance(node, Mapping):
        Reader(node, choice, what, problems)
        return None
    present = choice.present(node)
    if len(present) == 1:
        return present[0]
    message = f"{what} must have exactly one of the keys {', '.join(choice.chosen)}"
    hints = (nearest(key, choice.chosen) for key in node.entries if not present)
    hint = next((hint for hint in hints if "did you mean" in hint), "")
    problems.append(Problem(node.place, "bad-change", message + hint))
    return None


def label(node: Node, key: Key[Any]) -> str:
    """Return the plain value under a key, for use in messages; empty without one."""
    value = node.entries.get(key.name) if isinstance(node, Mapping) else None
    return str(value.value) if isinstance(value, Scalar) and value.value is not None else ""
