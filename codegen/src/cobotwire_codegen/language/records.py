"""Defines records: each mapping of the spec is a class, and its keys are the attributes.

The reader, the JSON schema and the reference page are all derived from these classes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping as ReadOnly
from functools import cache
from types import MappingProxyType
from typing import Any, ClassVar, Generic, TypeVar

from cobotwire_codegen.errors import Place
from cobotwire_codegen.language.json_schema import Schema, by_key, closed, either, ref
from cobotwire_codegen.language.shapes import Note, Shape, check_name, items_of
from cobotwire_codegen.load import Mapping, Node, Sequence

T = TypeVar("T")
Entry = tuple[str, Place, Node]
# The problem code of an empty value, and how to correct it.
Empty = tuple[str, str]


class Key(Generic[T]):
    """One key of a record: its shape, its meaning, and its default.

    ``absent`` is the problem code of a missing key; it is empty if the key is optional.
    """

    name: str

    def __init__(self, shape: Shape[T], doc: str, default: T, absent: str = "") -> None:
        self.shape, self.doc, self.default, self.absent = shape, doc, default, absent

    @property
    def required(self) -> bool:
        """Whether a record must have the key."""
        return bool(self.absent)

    def __set_name__(self, owner: type, name: str) -> None:
        # `class` and `except` are keywords of Python.
        self.name = name.removesuffix("_")

    def schema(self) -> Schema:
        """Return the schema of the key's value, with the description."""
        shape = self.shape.schema()
        # JSON Schema ignores other keywords beside a reference.
        return shape if "$ref" in shape else {**shape, "description": self.doc}


def required(shape: Shape[T], doc: str, absent: str = "missing-key") -> Key[T]:
    """Return a key that a record must have."""
    return Key(shape, doc, shape.blank, absent)


def optional(shape: Shape[T], doc: str, default: T | None = None) -> Key[T]:
    """Return a key that may be left out; then its value is the default, or the shape's blank."""
    return Key(shape, doc, shape.blank if default is None else default)


class Record:
    """A mapping of the spec. The docstring says what it describes; the attributes are its keys."""

    HEADING: ClassVar[str] = ""
    EXAMPLE: ClassVar[str] = ""
    # Pairs of keys that exclude each other.
    EXCLUSIVE: ClassVar[tuple[tuple[str, str], ...]] = ()
    # Limits of the language, by a key that a spec may use in an attempt to exceed the limit.
    LIMITS: ClassVar[ReadOnly[str, str]] = MappingProxyType({})

    @classmethod
    @cache
    def keys(cls) -> ReadOnly[str, Key[Any]]:
        """Return the keys by name, the required ones first."""
        found = [
            key
            for owner in reversed(cls.__mro__)
            for key in vars(owner).values()
            if isinstance(key, Key)
        ]
        # A key that a subclass describes again counts once.
        named = {key.name: key for key in found}
        ordered = sorted(named.items(), key=lambda item: not item[1].required)
        return MappingProxyType(dict(ordered))

    @classmethod
    def definition(cls) -> str:
        """Return the record's name in the schema."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()

    @classmethod
    def description(cls) -> str:
        """Return the record's description in one paragraph."""
        return " ".join((cls.__doc__ or "").split())

    @classmethod
    def schema(cls) -> Schema:
        """Return the schema of the mapping."""
        keys = cls.keys()
        properties = {name: key.schema() for name, key in keys.items()}
        made = closed(
            cls.description(), properties, (key.name for key in keys.values() if key.required)
        )
        both = [{"not": {"required": list(pair)}} for pair in cls.EXCLUSIVE]
        return {**made, "allOf": both} if both else made

    @classmethod
    def heading(cls) -> str:
        """Return the record's heading on the reference page."""
        return cls.HEADING or cls.definition().replace("_", " ").capitalize()


class Choice:
    """Several records for one place; the first key that is present decides which one is meant."""

    def __init__(
        self,
        definition: str,
        chosen: dict[str, Described],
        otherwise: Described | None = None,
    ) -> None:
        self.name, self.chosen, self.otherwise = definition, chosen, otherwise

    def definition(self) -> str:
        """Return the choice's name in the schema."""
        return self.name

    def options(self) -> tuple[Described, ...]:
        """Return every record and choice that can be meant."""
        return (*((self.otherwise,) if self.otherwise else ()), *self.chosen.values())

    def present(self, node: Node) -> list[str]:
        """Return the deciding keys that a node has."""
        held = node.entries if isinstance(node, Mapping) else {}
        return [key for key in self.chosen if key in held]

    def of(self, node: Node) -> type[Record]:
        """Return the record that a node is read as."""
        first = next((self.chosen[key] for key in self.present(node)), self.otherwise)
        found = first or next(iter(self.chosen.values()))
        return found.of(node) if isinstance(found, Choice) else found

    def schema(self) -> Schema:
        """Return the schema of the choice."""
        options = [(key, ref(record.definition())) for key, record in self.chosen.items()]
        if self.otherwise is not None:
            return by_key(options, ref(self.otherwise.definition()))
        alone = [{"required": [key]} for key in self.chosen]
        return {"oneOf": alone, **by_key(options, options[0][1])}


Described = type[Record] | Choice


class Part(Shape[Node | None]):
    """A mapping inside a mapping."""

    blank = None

    def __init__(self, record: Described) -> None:
        self.records = (record,)
        self.words = f"a mapping ({link(record)})"

    def read(self, node: Node, subject: str, note: Note) -> Node | None:
        """Return the node; another reader reads it."""
        return node

    def schema(self) -> Schema:
        """Return a reference to the record."""
        return ref(self.records[0].definition())


class Listed(Shape[tuple[Node, ...]]):
    """A list of mappings of one record."""

    blank = ()

    def __init__(self, record: Described, empty: Empty | None = None) -> None:
        self.records, self.empty = (record,), empty
        self.words = f"a list of {link(record)}"

    def read(self, node: Node, subject: str, note: Note) -> tuple[Node, ...]:
        """Return the nodes of the list."""
        found = items_of(node, subject, note)
        if isinstance(node, Sequence) and not found and self.empty:
            note(self.empty[0], f"{subject} is empty; {self.empty[1]}", node.place)
        return found

    def schema(self) -> Schema:
        """Return an array of the record."""
        shortest = {"minItems": 1} if self.empty else {}
        return {"type": "array", "items": ref(self.records[0].definition()), **shortest}


class ListedTwice(Shape[tuple[Node, ...]]):
    """A list of lists of mappings of one record."""

    blank = ()

    def __init__(self, record: Described) -> None:
        self.records = (record,)
        self.words = f"a list of lists of {link(record)}"

    def read(self, node: Node, subject: str, note: Note) -> tuple[Node, ...]:
        """Return the inner lists."""
        found = items_of(node, subject, note)
        for item in found:
            if not isinstance(item, Sequence):
                key = subject.split()[0]
                note("wrong-kind", f"{key} must list lists of fields", item.place)
        return tuple(item for item in found if isinstance(item, Sequence))

    def schema(self) -> Schema:
        """Return an array of arrays of the record."""
        return {"type": "array", "items": Listed(self.records[0]).schema()}


class Named(Shape[tuple[Entry, ...]]):
    """A mapping from names to values of one kind: records, or the values of a shape."""

    blank = ()

    def __init__(
        self, content: Described | Shape[Any], pattern: str, empty: Empty | None = None
    ) -> None:
        self.content, self.pattern, self.empty = content, pattern, empty
        self.records = content.records if isinstance(content, Shape) else (content,)
        shown = content.words if isinstance(content, Shape) else link(content)
        self.words = f"a mapping from names to {shown}"

    def read(self, node: Node, subject: str, note: Note) -> tuple[Entry, ...]:
        """Return the entries: name, place of the name, node."""
        if isinstance(node, Mapping) and not node.entries and self.empty:
            note(self.empty[0], f"{subject} is empty; {self.empty[1]}", node.place)
        return self.entries(node, subject, note)

    def entries(self, node: Node, subject: str, note: Note) -> tuple[Entry, ...]:
        """Return the entries; note a problem for each name that is not legal."""
        found = entries_of(node, subject, note)
        for name, place, _ in found:
            check_name(name, self.pattern, place, note)
        return found

    def schema(self) -> Schema:
        """Return an object with the content as values."""
        content = self.content
        inner = content.schema() if isinstance(content, Shape) else ref(content.definition())
        least = {"minProperties": 1} if self.empty else {}
        return {
            "type": "object",
            "propertyNames": {"pattern": self.pattern},
            "additionalProperties": inner,
            **least,
        }


class InFile(Shape[Node | None]):
    """The name of a file, or the content of the file itself."""

    blank = None

    def __init__(self, record: Described) -> None:
        self.records = (record,)
        self.words = f"a file name, or the content itself: {link(record)}"

    def read(self, node: Node, subject: str, note: Note) -> Node | None:
        """Return the node; the builder loads the file."""
        return node

    def schema(self) -> Schema:
        """Return a string, or else the record."""
        return or_file(ref(self.records[0].definition()))


class InFiles(Shape[Node | None]):
    """A list of file names and contents, or instead a value of the shape ``alone``."""

    blank = None

    def __init__(self, record: Described, alone: Shape[Any] | Schema | None = None) -> None:
        self.records = (record, *alone.records) if isinstance(alone, Shape) else (record,)
        self._alone = alone.schema() if isinstance(alone, Shape) else alone
        self.words = f"a list of file names or contents: {link(record)}"

    def read(self, node: Node, subject: str, note: Note) -> Node | None:
        """Return the node; the builder loads the files."""
        return node

    def schema(self) -> Schema:
        """Return an array of file names and contents, or the schema of ``alone``."""
        listed: Schema = {"type": "array", "items": or_file(ref(self.records[0].definition()))}
        return listed if self._alone is None else either("array", listed, self._alone)


def entries_of(node: Node, subject: str, note: Note) -> tuple[Entry, ...]:
    """Return the entries of a mapping; note a problem if the node is something else."""
    if isinstance(node, Mapping):
        return tuple((name, node.keys[name], value) for name, value in node.entries.items())
    note("wrong-kind", f"{subject} must be a mapping", node.place)
    return ()


def or_file(content: Schema) -> Schema:
    """Return the schema of a file name, or else of the content itself."""
    path: Schema = {"type": "string", "description": "A file, relative to this one."}
    return either("string", path, content)


class Changed(Shape[tuple[Entry, ...]]):
    """Some keys of some records with their new values."""

    blank = ()

    def __init__(self, *records: type[Record]) -> None:
        self.changed = records
        self.words = f"keys of {' or '.join(map(link, records))} with their new values"

    def keys(self) -> dict[str, Key[Any]]:
        """Return every key that can be set."""
        return {name: key for record in self.changed for name, key in record.keys().items()}

    def read(self, node: Node, subject: str, note: Note) -> tuple[Entry, ...]:
        """Return the entries; the reader of the changed mapping checks them."""
        return entries_of(node, subject, note)

    def schema(self) -> Schema:
        """Return a mapping of these keys, none of them required."""
        properties = {name: key.schema() for name, key in self.keys().items()}
        return closed("Keys with their new content.", properties, ())


def link(record: Described) -> str:
    """Return a record's name as the reference page links it."""
    if isinstance(record, Choice):
        return " or ".join(dict.fromkeys(map(link, record.options())))
    return f"[{record.heading()}](#{record.heading().lower().replace(' ', '-')})"


def nested(record: Described) -> tuple[Described, ...]:
    """Return the records and choices that a record refers to."""
    if isinstance(record, Choice):
        return record.options()
    return tuple(inner for key in record.keys().values() for inner in key.shape.records)
