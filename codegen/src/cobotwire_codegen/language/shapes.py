"""The values that a key of the spec can have: how each is read, its schema, and its description."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any, Generic, TypeVar

from cobotwire_codegen.errors import Place, nearest
from cobotwire_codegen.language.json_schema import Schema, either
from cobotwire_codegen.language.names import wrong_name
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence, exact

T = TypeVar("T")
# The first and last line of each span.
Spans = tuple[tuple[int, int], ...]
Note = Callable[[str, str, Place], None]

KIND = {Scalar: "a plain value", Sequence: "a list", Mapping: "a mapping"}
_EXACT = r"^\s*-?[0-9]+(\.[0-9]*)?(/[0-9]+)?\s*$"
_LINES = re.compile(r"(\d+)(?:-(\d+))?\Z")


class Shape(Generic[T]):
    """What a key's value can be.

    ``blank`` stands in for a value that is missing or wrong; ``words`` complete "must be ...";
    ``records`` are the records that the value contains.
    """

    blank: T
    words: str
    records: tuple[Any, ...] = ()

    def read(self, node: Node, subject: str, note: Note) -> T:
        """Return the value of a node; note a problem and return ``blank`` if it does not fit."""
        raise NotImplementedError

    def schema(self) -> Schema:
        """Return the JSON Schema of the value."""
        raise NotImplementedError

    def _wrong(self, node: Node, subject: str, note: Note, code: str = "wrong-kind") -> T:
        note(code, f"{subject} must be {self.words}", node.place)
        return self.blank


class Text(Shape[str]):
    """A word or sentence; a number is read as its digits."""

    blank = ""
    words = "text"

    def read(self, node: Node, subject: str, note: Note) -> str:
        """Return the text with every run of white space as one space."""
        value = node.value if isinstance(node, Scalar) else None
        if type(value) is int:
            return str(value)
        if not isinstance(value, str) or not value.strip():
            return self._wrong(node, subject, note)
        return " ".join(value.split())

    def schema(self) -> Schema:
        """Return a string or integer that is not blank."""
        return {"type": ["string", "integer"], "pattern": r"\S"}


class Name(Text):
    """A name of the generated code, of the given pattern."""

    def __init__(self, pattern: str, words: str = "a name") -> None:
        self.pattern, self.words = pattern, words

    def read(self, node: Node, subject: str, note: Note) -> str:
        """Return the name; note a problem if it is not legal."""
        name = super().read(node, subject, note)
        if name:
            check_name(name, self.pattern, node.place, note)
        return name

    def schema(self) -> Schema:
        """Return a string of the pattern."""
        return {"type": "string", "pattern": self.pattern}


class Known(Text):
    """The name of something that the spec itself defines; the schema lists the known names."""

    def __init__(self, definition: str, words: str) -> None:
        self.definition, self.words = definition, words

    def schema(self) -> Schema:
        """Return a reference to the list of known names."""
        return {"$ref": f"#/definitions/{self.definition}"}


class Whole(Shape[int]):
    """A whole number, within bounds where they are given."""

    def __init__(
        self, lowest: int | None = None, highest: int | None = None, code: str = "bad-number"
    ) -> None:
        self.lowest, self.highest, self.code = lowest, highest, code
        self.blank = lowest or 0
        self.words = f"a whole number {self.bounds}".strip()

    @property
    def bounds(self) -> str:
        """The bounds in words; empty if there are none."""
        if self.lowest is not None and self.highest is not None:
            return f"in {self.lowest}..{self.highest}"
        return f"of at least {self.lowest}" if self.lowest is not None else ""

    def read(self, node: Node, subject: str, note: Note) -> int:
        """Return the number."""
        value = node.value if isinstance(node, Scalar) else None
        # In Python, True is an int; in the spec, it is not a number.
        if type(value) is not int:
            return self._wrong(node, subject, note)
        low = self.lowest is not None and value < self.lowest
        if low or (self.highest is not None and value > self.highest):
            shown = value if abs(value) < 10**40 else "a number of more than 40 digits"
            allowed = self.bounds.removeprefix("of ").removeprefix("in ")
            note(self.code, f"{subject} is {shown}; allowed: {allowed}", node.place)
            return self.blank
        return value

    def schema(self) -> Schema:
        """Return an integer with its bounds."""
        bounds = {"minimum": self.lowest, "maximum": self.highest}
        return {"type": "integer", **{k: v for k, v in bounds.items() if v is not None}}


class Span(Shape[tuple[int, int]]):
    """A whole number, or a pair of them: the lowest and the highest."""

    blank = (0, 0)
    words = "a whole number, or [lowest, highest]"

    def read(self, node: Node, subject: str, note: Note) -> tuple[int, int]:
        """Return the two numbers, which are the same if only one is given."""
        items = node.items if isinstance(node, Sequence) else (node, node)
        ends = [item.value if isinstance(item, Scalar) else None for item in items]
        if len(ends) == 2 and all(type(end) is int and 0 <= end < 2**16 for end in ends):
            low, high = ends
            if low <= high:  # type: ignore[operator]  # both are integers
                return low, high  # type: ignore[return-value]  # both are integers
        return self._wrong(node, subject, note, "bad-size")

    def schema(self) -> Schema:
        """Return a whole number, or an array of two."""
        one: Schema = {"type": "integer", "minimum": 0, "maximum": 65535}
        return either("array", {"items": one, "minItems": 2, "maxItems": 2}, one)


class YesNo(Shape[bool]):
    """True or false."""

    blank = False
    words = "true or false"

    def read(self, node: Node, subject: str, note: Note) -> bool:
        """Return the truth value."""
        if isinstance(node, Scalar) and isinstance(node.value, bool):
            return node.value
        return self._wrong(node, subject, note)

    def schema(self) -> Schema:
        """Return a boolean."""
        return {"type": "boolean"}


class Word(Shape[str]):
    """A word of a closed list; ``docs`` describe the words."""

    def __init__(self, known: Iterable[str], docs: Iterable[str] = ()) -> None:
        self.known, self.docs = tuple(known), tuple(docs)
        self.blank = self.known[0]
        self.words = f"one of {', '.join(f'`{word}`' for word in self.known)}"

    def read(self, node: Node, subject: str, note: Note) -> str:
        """Return the word."""
        if isinstance(node, Scalar) and node.value in self.known:
            return str(node.value)
        given = str(node.value) if isinstance(node, Scalar) else KIND[type(node)]
        hint = nearest(given, self.known)
        note("unknown-word", f"{subject} cannot be {given}{hint}", node.place)
        return self.blank

    def schema(self) -> Schema:
        """Return the list of words."""
        beside = {"enumDescriptions": list(self.docs)} if self.docs else {}
        return {"enum": list(self.known), **beside}


class Catalogued(Word):
    """A word of a list that is too long to show; the first words have descriptions."""

    def __init__(self, known: Iterable[str], docs: Iterable[str]) -> None:
        super().__init__(known)
        self.docs = tuple(docs)
        first, last = self.known[: len(self.docs)], self.known[-1]
        shown = ", ".join(f"`{word}`" for word in first)
        self.words = f"one of {shown}, or a name of the catalogue such as `{last}`"

    def schema(self) -> Schema:
        """Return the list of words; only the first ones have descriptions."""
        return {"enum": list(self.known)}


class Exact(Shape[Fraction]):
    """A positive number with an exact value: 1/100, 0.01 or 3."""

    blank = Fraction(1)
    words = "a positive number"

    def read(self, node: Node, subject: str, note: Note) -> Fraction:
        """Return the number as a fraction."""
        value = as_fraction(node)
        if value is None or value <= 0:
            return self._wrong(node, subject, note, "bad-number")
        return value

    def schema(self) -> Schema:
        """Return a number, or a string with a fraction."""
        return {"type": ["number", "string"], "pattern": _EXACT}


class Real(Shape[Fraction]):
    """Any number with an exact value: -110.4, 1/100 or 0."""

    blank = Fraction(0)
    words = "a number"

    def read(self, node: Node, subject: str, note: Note) -> Fraction:
        """Return the number as a fraction."""
        value = as_fraction(node)
        return self._wrong(node, subject, note, "bad-number") if value is None else value

    def schema(self) -> Schema:
        """Return a number, or a string with a fraction."""
        return {"type": ["number", "string"], "pattern": _EXACT}


class Range(Shape[tuple[Fraction, Fraction] | None]):
    """A pair of numbers, the lowest and the highest."""

    blank = None
    words = "[lowest, highest]"

    def read(self, node: Node, subject: str, note: Note) -> tuple[Fraction, Fraction] | None:
        """Return the two numbers."""
        ends = [as_fraction(item) for item in node.items] if isinstance(node, Sequence) else []
        if len(ends) == 2 and ends[0] is not None and ends[1] is not None and ends[0] <= ends[1]:
            return ends[0], ends[1]
        return self._wrong(node, subject, note, "bad-range")

    def schema(self) -> Schema:
        """Return an array of two numbers."""
        return {"type": "array", "items": Exact().schema(), "minItems": 2, "maxItems": 2}


class Hex(Shape[bytes | None]):
    """Bytes as pairs of hex digits."""

    blank = None
    words = "pairs of hex digits"

    def read(self, node: Node, subject: str, note: Note) -> bytes | None:
        """Return the bytes."""
        try:
            return bytes.fromhex(str(node.value) if isinstance(node, Scalar) else "-")
        except ValueError:
            return self._wrong(node, subject, note, "bad-hex")

    def schema(self) -> Schema:
        """Return a string or integer: YAML reads pairs without a letter as a number."""
        return {"type": ["string", "integer"], "pattern": r"^\s*([0-9A-Fa-f]{2}\s*)*$"}


class Lines(Shape[Spans]):
    """Lines of the protocol document: 12, 20-39, or a list of these."""

    blank = ()
    words = "lines of the document (12, 20-39, or a list of these)"

    def read(self, node: Node, subject: str, note: Note) -> Spans:
        """Return the first and last line of each span."""
        found = []
        for item in node.items if isinstance(node, Sequence) else (node,):
            match = _LINES.match(str(item.value)) if isinstance(item, Scalar) else None
            first = int(match[1]) if match else 0
            last = int(match[2] or first) if match else 0
            if 1 <= first <= last:
                found.append((first, last))
            else:
                self._wrong(item, subject, note, "bad-lines")
        return tuple(found)

    def schema(self) -> Schema:
        """Return one span, or a list of spans."""
        pattern = "^" + _LINES.pattern.replace(r"\d", "[0-9]").replace(r"\Z", "$")
        one: Schema = {"type": ["integer", "string"], "minimum": 1, "pattern": pattern}
        return either("array", {"items": one}, one)


class Names(Shape[tuple[str, ...]]):
    """One name, or a list of names."""

    blank = ()
    words = "a name or a list of names"

    def read(self, node: Node, subject: str, note: Note) -> tuple[str, ...]:
        """Return the names."""
        found = []
        for item in node.items if isinstance(node, Sequence) else (node,):
            if isinstance(item, Scalar) and isinstance(item.value, str):
                found.append(item.value)
            else:
                self._wrong(item, subject, note)
        return tuple(found)

    def schema(self) -> Schema:
        """Return one string, or an array of strings."""
        one: Schema = {"type": "string"}
        return either("array", {"items": one}, one)


class Texts(Shape[tuple[str, ...]]):
    """A list of words or sentences."""

    blank = ()
    words = "a list of texts"

    def read(self, node: Node, subject: str, note: Note) -> tuple[str, ...]:
        """Return the texts, each with every run of white space as one space."""
        found = []
        for item in items_of(node, subject, note):
            if isinstance(item, Scalar) and isinstance(item.value, str):
                found.append(" ".join(item.value.split()))
            else:
                note("wrong-kind", f"{subject} must list texts", item.place)
        return tuple(found)

    def schema(self) -> Schema:
        """Return an array of strings."""
        return {"type": "array", "items": {"type": "string"}}


class Numbers(Shape[tuple[int, ...]]):
    """A list of whole numbers."""

    blank = ()
    words = "a list of whole numbers"

    def read(self, node: Node, subject: str, note: Note) -> tuple[int, ...]:
        """Return the numbers."""
        found = []
        for item in items_of(node, subject, note):
            if isinstance(item, Scalar) and type(item.value) is int:
                found.append(item.value)
            else:
                note("wrong-kind", f"{subject} must be whole numbers", item.place)
        return tuple(found)

    def schema(self) -> Schema:
        """Return an array of integers."""
        return {"type": "array", "items": {"type": "integer"}, "minItems": 1}


class Anything(Shape[Node | None]):
    """A node that the builder reads by itself; ``given`` is its schema."""

    blank = None

    def __init__(self, words: str, given: Schema) -> None:
        self.words, self._schema = words, given

    def read(self, node: Node, subject: str, note: Note) -> Node | None:
        """Return the node itself."""
        return node

    def schema(self) -> Schema:
        """Return the given schema."""
        return self._schema


def check_name(name: str, pattern: str, place: Place, note: Note) -> None:
    """Note a problem if a name is not legal for its kind."""
    wrong = wrong_name(name, pattern)
    if wrong:
        note("bad-name", wrong, place)


def items_of(node: Node, subject: str, note: Note) -> tuple[Node, ...]:
    """Return the nodes of a list; note a problem if the node is something else."""
    if isinstance(node, Sequence):
        return node.items
    note("wrong-kind", f"{subject} must be a list", node.place)
    return ()


def as_fraction(node: Node) -> Fraction | None:
    """Return the exact number that a node holds, or None."""
    value = node.value if isinstance(node, Scalar) else None
    if isinstance(value, bool) or not isinstance(value, int | Fraction | str):
        return None
    try:
        return exact(value) if isinstance(value, str) else Fraction(value)
    except (ValueError, ZeroDivisionError):
        return None
