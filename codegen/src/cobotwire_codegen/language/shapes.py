"""The values that a key of the spec can have: how each is read, its schema, and its description."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any, Generic, TypeVar

from cobotwire_codegen.catalogue import check_hint
from cobotwire_codegen.errors import Place, nearest
from cobotwire_codegen.language.json_schema import Schema, either
from cobotwire_codegen.language.names import wrong_name
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence

T = TypeVar("T")
# The first and last line of each span.
Spans = tuple[tuple[int, int], ...]
Note = Callable[[str, str, Place], None]

KIND = {Scalar: "a plain value", Sequence: "a list", Mapping: "a mapping"}
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
        note("unknown-word", f"{subject} cannot be {given}{self.hint(given)}", node.place)
        return self.blank

    def hint(self, given: str) -> str:
        """Return a hint for an unknown word."""
        return nearest(given, self.known)

    def schema(self) -> Schema:
        """Return the list of words."""
        beside = {"enumDescriptions": list(self.docs)} if self.docs else {}
        return {"enum": list(self.known), **beside}


class Catalogued(Word):
    """A check; the list is too long to show, and only the words that are not CRCs have docs."""

    def __init__(self, known: Iterable[str], docs: Iterable[str]) -> None:
        super().__init__(known)
        self.docs = tuple(docs)
        first, last = self.known[: len(self.docs)], self.known[-1]
        shown = ", ".join(f"`{word}`" for word in first)
        self.words = f"one of {shown}, or a name of the catalogue such as `{last}`"

    def hint(self, given: str) -> str:
        """Return a hint for an unknown check."""
        return check_hint(given, self.known[: len(self.docs)])

    def schema(self) -> Schema:
        """Return the list of words; only the first ones have descriptions."""
        return {"enum": list(self.known)}


class Hex(Shape[bytes | None]):
    """Bytes as pairs of hex digits."""

    blank = None
    words = "pairs of hex digits, such as FE 0A"

    def read(self, node: Node, subject: str, note: Note) -> bytes | None:
        """Return the bytes."""
        try:
            text = (node.text or str(node.value)) if isinstance(node, Scalar) else "-"
            return bytes.fromhex(text)
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

    def __init__(self, pattern: str = "") -> None:
        self.pattern = pattern

    def read(self, node: Node, subject: str, note: Note) -> tuple[str, ...]:
        """Return the names; note a problem for each that does not match the pattern."""
        found = []
        for item in node.items if isinstance(node, Sequence) else (node,):
            if isinstance(item, Scalar) and isinstance(item.value, str):
                found.append(item.value)
                if self.pattern:
                    check_name(item.value, self.pattern, item.place, note)
            else:
                self._wrong(item, subject, note)
        return tuple(found)

    def schema(self) -> Schema:
        """Return one string, or an array of strings."""
        pattern = {"pattern": self.pattern} if self.pattern else {}
        one: Schema = {"type": "string", **pattern}
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
