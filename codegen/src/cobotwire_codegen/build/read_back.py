"""Builds ``read_by`` (the query that reports what a command has set) and ``samples``."""

from __future__ import annotations

from cobotwire_codegen import language
from cobotwire_codegen.language.number_shapes import Numbers
from cobotwire_codegen.language.records import entries_of
from cobotwire_codegen.language.shapes import items_of
from cobotwire_codegen.load import Mapping, Node, Scalar
from cobotwire_codegen.model import ReadBack, Samples
from cobotwire_codegen.reader import Reader


def build_read_back(reader: Reader) -> ReadBack | None:
    """Return how to read what the command sets; None if the spec names no query."""
    key = language.Command.read_by
    node = reader.get(key)
    if node is None:
        return None
    if isinstance(node, Scalar) and isinstance(node.value, str):
        return ReadBack(node.place, node.value, ())
    if isinstance(node, Mapping) and len(node.entries) == 1:
        ((query, fields),) = node.entries.items()
        pairs = _pairs(fields)
        if pairs:
            return ReadBack(node.place, query, pairs)
    message = f"{key.name} of {reader.what} must be {key.shape.words}"
    reader.problem("wrong-kind", message, node.place)
    return None


def _pairs(node: Node) -> tuple[tuple[str, str | int], ...]:
    """Return each reply field with the argument or number that it repeats; empty if invalid."""
    entries = node.entries if isinstance(node, Mapping) else {}
    pairs: list[tuple[str, str | int]] = []
    for name, content in entries.items():
        value = content.value if isinstance(content, Scalar) else None
        if isinstance(value, bool) or not isinstance(value, str | int):
            return ()
        pairs.append((name, value))
    return tuple(pairs)


def build_samples(reader: Reader) -> tuple[Samples, ...]:
    """Return the raw values that a conformance run may send; without an entry it may send all."""
    key = language.Command.samples
    node = reader.get(key)
    subject = f"{key.name} of {reader.what}"
    listed = () if node is None else items_of(node, subject, reader.problem)
    return tuple(_samples(entry, subject, reader) for entry in listed)


def _samples(node: Node, subject: str, reader: Reader) -> Samples:
    return tuple(
        (name, Numbers().read(values, f"{name} in {subject}", reader.problem))
        for name, _, values in entries_of(node, f"an entry of {subject}", reader.problem)
    )
