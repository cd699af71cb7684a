"""Turns nodes of the errata and vectors files into errata and vectors."""

from __future__ import annotations

from fractions import Fraction

from cobotwire_codegen import language
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.language.records import Key, entries_of
from cobotwire_codegen.language.shapes import items_of
from cobotwire_codegen.load import Node, Scalar, Sequence
from cobotwire_codegen.model import Erratum, Limits, Vector
from cobotwire_codegen.reader import Reader, label


def build_erratum(node: Node, problems: list[Problem]) -> Erratum:
    """Return an entry of the errata file."""
    spec = language.Erratum
    reader = Reader(node, spec, "an erratum", problems)
    return Erratum(
        place=node.place,
        lines=reader.get(spec.line),
        kind=reader.get(spec.kind),
        commands=reader.get(spec.commands),
        example=reader.get(spec.example) or None,
        says=reader.get(spec.says),
        read=reader.get(spec.read),
        why=reader.get(spec.why),
    )


def build_vector(node: Node, problems: list[Problem]) -> Vector:
    """Return an entry of a vectors file."""
    spec, printed = language.NamedVector, language.ExampleVector
    number = label(node, printed.example)
    name = f"example-{number}" if number else label(node, spec.name)
    reader = Reader(node, language.VECTOR, f"the vector {name}".strip(), problems)
    example = reader.get(printed.example) if number else None
    # These keys inform readers of the file: they name the origin of a vector.
    reader.get(spec.source)
    reader.get(spec.why)
    return Vector(
        place=node.place,
        name=name if example else reader.get(spec.name),
        example=example,
        line=reader.get(spec.line) or None,
        command=reader.get(spec.command),
        direction="reply" if reader.get(spec.direction) == "reply" else "request",
        printed=reader.get(spec.printed),
        verdict=reader.get(printed.verdict) if example else "consistent",
        frame=reader.get(spec.frame),
        text=reader.get(spec.text) or None,
        values=_values(reader),
        says=reader.get(spec.says),
        rejected=_rejected(reader),
        accepted=_limits(reader, spec.accepted),
        refused=_limits(reader, spec.refused),
    )


def _rejected(outer: Reader) -> tuple[str, int] | None:
    spec = language.Rejection
    node = outer.get(language.NamedVector.rejected)
    if node is None:
        return None
    reader = Reader(node, spec, f"the rejection of {outer.what}", outer.problems)
    return reader.get(spec.reason), reader.get(spec.offset)


def _values(reader: Reader) -> tuple[tuple[str, object], ...]:
    key = language.NamedVector.values
    node = reader.get(key)
    if node is None:
        return ()
    found = entries_of(node, f"{key.name} of {reader.what}", reader.problem)
    return tuple((name, plain_value(value)) for name, _, value in found)


def _limits(reader: Reader, key: Key[Node | None]) -> Limits:
    node = reader.get(key)
    if node is None:
        return ()
    subject = f"{key.name} of {reader.what}"
    return tuple(
        (name, tuple(plain_value(item) for item in items_of(values, subject, reader.problem)))
        for name, _, values in entries_of(node, subject, reader.problem)
    )


def plain_value(node: Node) -> object:
    """Return a value as the spec states it: an exact number, a word, true or false, or a tuple."""
    if isinstance(node, Sequence):
        return tuple(plain_value(item) for item in node.items)
    value = node.value if isinstance(node, Scalar) else None
    # Integers become int; every other number stays an exact fraction.
    return int(value) if isinstance(value, Fraction) and value.denominator == 1 else value
