"""Nodes of the errata and vectors files."""

from __future__ import annotations

from fractions import Fraction

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.load import Node, Scalar, Sequence
from cobotwire_codegen.model import ERRATUM_KINDS, REASONS, VERDICTS, Erratum, Vector
from cobotwire_codegen.reader import Reader


def build_erratum(node: Node, problems: list[Problem]) -> Erratum:
    """An entry of the errata file."""
    reader = Reader(node, "an erratum", problems)
    reader.required("line")
    erratum = Erratum(
        place=node.place,
        lines=reader.lines("line"),
        kind=reader.one_of("kind", ERRATUM_KINDS),
        commands=reader.texts("commands"),
        example=reader.integer("example", 0) or None,
        says=reader.text("says"),
        read=reader.text("read"),
        why=reader.text("why"),
    )
    reader.done()
    return erratum


def build_vector(node: Node, problems: list[Problem]) -> Vector:
    """An entry of a vectors file."""
    reader = Reader(node, "a vector", problems)
    example = reader.integer("example", 0) or None
    name = f"example-{example}" if example else reader.text("name")
    reader.what = f"the vector {name}"
    reply = reader.one_of("direction", ("request", "reply")) == "reply"
    vector = Vector(
        place=node.place,
        name=name,
        example=example,
        line=reader.integer("line", 0) or None,
        command=reader.text("command"),
        direction="reply" if reply else "request",
        printed=reader.bytes("printed"),
        verdict=reader.one_of("verdict", VERDICTS) if example else "consistent",
        frame=reader.bytes("frame"),
        text=reader.text("text", "") or None,
        values=_values(reader),
        says=reader.text("says", ""),
        refused=_refused(reader, problems),
    )
    # Said for the reader of the file: where a vector that the document lacks comes from.
    reader.lines("source")
    reader.text("why", "")
    reader.done()
    return vector


def _refused(outer: Reader, problems: list[Problem]) -> tuple[str, int] | None:
    node = outer.node("refused")
    if node is None:
        return None
    reader = Reader(node, f"the refusal of {outer.what}", problems)
    refused = (reader.one_of("reason", REASONS), reader.integer("offset"))
    reader.done()
    return refused


def _values(reader: Reader) -> tuple[tuple[str, object], ...]:
    return tuple((name, _plain(node)) for name, _, node in reader.entries("values"))


def _plain(node: Node) -> object:
    if isinstance(node, Sequence):
        return tuple(_plain(item) for item in node.items)
    value = node.value if isinstance(node, Scalar) else None
    # Exact where the file is exact; whole numbers stay whole.
    return int(value) if isinstance(value, Fraction) and value.denominator == 1 else value
