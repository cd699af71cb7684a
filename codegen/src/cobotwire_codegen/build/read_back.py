"""``read_by``: which query tells what a command has set."""

from __future__ import annotations

from cobotwire_codegen.load import Mapping, Node, Scalar
from cobotwire_codegen.model import ReadBack
from cobotwire_codegen.reader import Reader

_ALLOWED = "a query's name, or {QUERY: {reply field: request field or whole number}}"


def build_read_back(reader: Reader) -> ReadBack | None:
    """The way to read what the command sets; None where the spec names none."""
    node = reader.node("read_by")
    if node is None:
        return None
    if isinstance(node, Scalar) and isinstance(node.value, str):
        return ReadBack(node.place, node.value, ())
    if isinstance(node, Mapping) and len(node.entries) == 1:
        ((query, fields),) = node.entries.items()
        pairs = _pairs(fields)
        if pairs:
            return ReadBack(node.place, query, pairs)
    reader.problem("wrong-kind", f"read_by of {reader.what} must be {_ALLOWED}", node.place)
    return None


def _pairs(node: Node) -> tuple[tuple[str, str | int], ...]:
    """Fields of the reply with what they repeat; none where something else stands there."""
    entries = node.entries if isinstance(node, Mapping) else {}
    pairs: list[tuple[str, str | int]] = []
    for name, said in entries.items():
        value = said.value if isinstance(said, Scalar) else None
        if isinstance(value, bool) or not isinstance(value, str | int):
            return ()
        pairs.append((name, value))
    return tuple(pairs)
