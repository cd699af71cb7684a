"""Walk a spec file and the schema together, to find the definition of each mapping."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, NamedTuple

from jsonschema import Draft7Validator

from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence

Path = tuple[str | int, ...]


class Closed(NamedTuple):
    """A mapping whose keys the schema lists."""

    definition: str
    schema: dict[str, Any]
    node: Mapping
    path: Path


class Word(NamedTuple):
    """A word of a closed list; ``definition`` and ``key`` identify the list."""

    definition: str
    key: str
    path: Path


def plain(node: Node) -> Any:
    """Return a node as the data that an editor's validator sees."""
    if isinstance(node, Mapping):
        return {key: plain(value) for key, value in node.entries.items()}
    if isinstance(node, Sequence):
        return [plain(item) for item in node.items]
    value = node.value
    return float(value) if isinstance(value, Fraction) else value


class Walk:
    """One schema, walked along many files."""

    def __init__(self, schema: dict[str, Any]) -> None:
        self.schema = schema
        self.validator = Draft7Validator(schema)

    def closed(self, root: Node) -> Iterator[Closed]:
        """Yield every mapping of a file that has a closed list of keys."""
        found = self._walk(self.schema, root, "", ())
        return (item for item in found if isinstance(item, Closed))

    def words(self, root: Node) -> Iterator[Word]:
        """Yield every word of a file that belongs to a closed list."""
        found = self._walk(self.schema, root, "", ())
        return (item for item in found if isinstance(item, Word))

    def _walk(
        self, schema: dict[str, Any], node: Node, name: str, path: Path
    ) -> Iterator[Closed | Word]:
        schema, name = self._picked(schema, node, name)
        if isinstance(node, Scalar):
            if "enum" in schema:
                keys = [key for key in path if isinstance(key, str)]
                yield Word(name, keys[-1], path)
        elif isinstance(node, Sequence):
            for index, item in enumerate(node.items):
                yield from self._walk(schema.get("items", {}), item, name, (*path, index))
        else:
            if schema.get("additionalProperties") is False:
                yield Closed(name, schema, node, path)
            for key, value in node.entries.items():
                more = schema.get("additionalProperties")
                inner = schema.get("properties", {}).get(key, more or {})
                yield from self._walk(inner, value, f"{name}/{key}", (*path, key))

    def _picked(self, schema: dict[str, Any], node: Node, name: str) -> tuple[dict[str, Any], str]:
        """Follow references and conditions to the schemas that apply to this node."""
        while "$ref" in schema or "if" in schema:
            if "$ref" in schema:
                name = schema["$ref"].rpartition("/")[2]
                schema = self.schema["definitions"][name]
            else:
                fits = self.validator.evolve(schema=schema["if"]).is_valid(plain(node))
                schema = schema["then" if fits else "else"]
        return schema, name
