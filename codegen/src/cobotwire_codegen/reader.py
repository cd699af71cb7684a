"""Reads one mapping of the spec key by key; everything that does not fit becomes a problem.

A reader never stops at the first problem: it notes it and gives a harmless stand-in, so that one
run tells all that is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from fractions import Fraction

from cobotwire_codegen.errors import Place, Problem, nearest
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, exact
from cobotwire_codegen.model import Lines

_RANGE = re.compile(r"(\d+)(?:-(\d+))?\Z")
_KIND = {Scalar: "a plain value", Sequence: "a list", Mapping: "a mapping"}


class Reader:
    """One mapping; ``done`` reports the keys that nobody asked for."""

    def __init__(self, node: Node, what: str, problems: list[Problem]) -> None:
        self.place = node.place
        self.what = what
        self.problems = problems
        self.root = node
        self._asked: set[str] = set()
        self._node = node if isinstance(node, Mapping) else Mapping(node.place, {})
        if not isinstance(node, Mapping):
            self.problem("wrong-kind", f"{what} is {_KIND[type(node)]}, but must be a mapping")
            self._asked_all = True
        else:
            self._asked_all = False

    def problem(self, code: str, message: str, place: Place | None = None) -> None:
        """Note a problem."""
        self.problems.append(Problem(place or self.place, code, message))

    def done(self) -> None:
        """Report unknown keys."""
        for key in self._node.entries.keys() - self._asked:
            hint = nearest(key, self._asked)
            self.problem("unknown-key", f"{self.what} has no key {key}{hint}", self._node.keys[key])

    def node(self, key: str) -> Node | None:
        """The node under a key, or None."""
        self._asked.add(key)
        return self._node.entries.get(key)

    def required(self, key: str) -> Node | None:
        """The node under a key that must be there."""
        node = self.node(key)
        if node is None and not self._asked_all:
            self.problem("missing-key", f"{self.what} lacks the key {key}")
        return node

    def text(self, key: str, default: str | None = None) -> str:
        """A word or sentence."""
        node = self.required(key) if default is None else self.node(key)
        if node is None:
            return default or ""
        if isinstance(node, Scalar) and isinstance(node.value, str) and node.value.strip():
            text = " ".join(node.value.split())
            odd = next((letter for letter in text if not letter.isprintable()), None)
            if odd is not None:
                message = f"{key} of {self.what} holds U+{ord(odd):04X}, which cannot be printed"
                self.problem("bad-character", message, node.place)
                return default or ""
            return text
        if isinstance(node, Scalar) and type(node.value) is int and default is None:
            return str(node.value)
        self.problem("wrong-kind", f"{key} of {self.what} must be text", node.place)
        return default or ""

    def positive(self, key: str, default: int | None = None) -> int:
        """A whole number above 0."""
        value = self.integer(key, default)
        node = self.node(key)
        if value <= 0 and isinstance(node, Scalar) and type(node.value) is int:
            self.problem("bad-number", f"{key} of {self.what} must be above 0", node.place)
        return value

    def integer(self, key: str, default: int | None = None) -> int:
        """A whole number."""
        node = self.required(key) if default is None else self.node(key)
        if node is None:
            return default or 0
        # bool is an int to Python, not to a reader of the spec.
        if isinstance(node, Scalar) and type(node.value) is int:
            return node.value
        self.problem("wrong-kind", f"{key} of {self.what} must be a whole number", node.place)
        return default or 0

    def one_of(self, key: str, known: tuple[str, ...], default: str | None = None) -> str:
        """A word from a closed list."""
        node = self.required(key) if default is None else self.node(key)
        fallback = default if default is not None else known[0]
        if node is None:
            return fallback
        if isinstance(node, Scalar) and node.value in known:
            return str(node.value)
        given = str(node.value) if isinstance(node, Scalar) else _KIND[type(node)]
        hint = nearest(given, known)
        self.problem("unknown-word", f"{key} of {self.what} cannot be {given}{hint}", node.place)
        return fallback

    def bytes(self, key: str) -> bytes | None:
        """Bytes as hex pairs; None where the key is left out."""
        node = self.node(key)
        if node is None:
            return None
        text = str(node.value) if isinstance(node, Scalar) else ""
        try:
            return bytes.fromhex(text)
        except ValueError:
            self.problem("bad-hex", f"{key} of {self.what} must be pairs of hex digits", node.place)
            return None

    def names(self, key: str) -> list[str]:
        """A word, or a list of words."""
        node = self.node(key)
        nodes = node.items if isinstance(node, Sequence) else (node,) if node is not None else ()
        found = []
        for item in nodes:
            if isinstance(item, Scalar) and isinstance(item.value, str):
                found.append(item.value)
            else:
                self.problem("wrong-kind", f"{key} of {self.what} must be names", item.place)
        return found

    def yes(self, key: str) -> bool:
        """A truth value; no where the key is left out."""
        node = self.node(key)
        if node is None:
            return False
        if isinstance(node, Scalar) and isinstance(node.value, bool):
            return node.value
        self.problem("wrong-kind", f"{key} of {self.what} must be true or false", node.place)
        return False

    def items(self, key: str) -> Iterator[Node]:
        """The nodes of a list; none where the key is left out."""
        node = self.node(key)
        if node is None:
            return
        if not isinstance(node, Sequence):
            self.problem("wrong-kind", f"{key} of {self.what} must be a list", node.place)
            return
        yield from node.items

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of words or sentences."""
        found = []
        for node in self.items(key):
            if isinstance(node, Scalar) and isinstance(node.value, str):
                found.append(" ".join(node.value.split()))
            else:
                self.problem("wrong-kind", f"{key} of {self.what} must list texts", node.place)
        return tuple(found)

    def entries(self, key: str) -> Iterator[tuple[str, Place, Node]]:
        """The entries of a mapping: key, its place, node; none where the key is left out."""
        node = self.node(key)
        if node is None:
            return
        if not isinstance(node, Mapping):
            self.problem("wrong-kind", f"{key} of {self.what} must be a mapping", node.place)
            return
        for name, value in node.entries.items():
            yield name, node.keys[name], value

    def fraction(self, key: str, default: Fraction) -> Fraction:
        """An exact number: 1/100, 0.01 or 3."""
        node = self.node(key)
        if node is None:
            return default
        exact = as_fraction(node)
        if exact is None or exact <= 0:
            self.problem(
                "bad-number", f"{key} of {self.what} must be a positive number", node.place
            )
            return default
        return exact

    def range(self, key: str) -> tuple[Fraction, Fraction] | None:
        """A pair of numbers, lowest and highest."""
        found = self.node(key)
        if found is None:
            return None
        nodes = tuple(self.items(key))
        ends = [as_fraction(node) for node in nodes]
        if len(ends) == 2 and ends[0] is not None and ends[1] is not None and ends[0] <= ends[1]:
            return ends[0], ends[1]
        self.problem("bad-range", f"{key} of {self.what} must be [lowest, highest]", found.place)
        return None

    def lines(self, key: str) -> Lines:
        """Lines of the document: 12, 20-39, or a list of these."""
        node = self.node(key)
        nodes: Iterable[Node] = (node,) if node is not None else ()
        if isinstance(node, Sequence):
            nodes = node.items
        found = []
        for item in nodes:
            match = _RANGE.match(str(item.value)) if isinstance(item, Scalar) else None
            first = int(match[1]) if match else 0
            last = int(match[2] or first) if match else 0
            if not 1 <= first <= last:
                self.problem("bad-lines", f"{key} of {self.what} must be lines", item.place)
            else:
                found.append((first, last))
        return tuple(found)


def as_fraction(node: Node) -> Fraction | None:
    """The exact number that a node says, or None."""
    value = node.value if isinstance(node, Scalar) else None
    if isinstance(value, bool) or not isinstance(value, int | Fraction | str):
        return None
    try:
        return exact(value) if isinstance(value, str) else Fraction(value)
    except (ValueError, ZeroDivisionError):
        return None
