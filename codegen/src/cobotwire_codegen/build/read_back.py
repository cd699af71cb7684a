"""``read_by``: which query tells what a command has set, and ``tries``, what may be set."""

from __future__ import annotations

from cobotwire_codegen.load import Mapping, Node, Scalar
from cobotwire_codegen.model import ReadBack, Tries
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


def build_tries(reader: Reader) -> tuple[Tries, ...]:
    """The numbers that a conformance run may send, form by form; none: every legal one."""
    found = []
    for node in reader.items("tries"):
        inner = Reader(node, f"an entry of tries of {reader.what}", reader.problems)
        names = node.entries if isinstance(node, Mapping) else {}
        found.append(tuple((name, _numbers(inner, name)) for name in names))
        inner.done()
    return tuple(found)


def _numbers(reader: Reader, name: str) -> tuple[int, ...]:
    values = [item.value for item in reader.items(name) if isinstance(item, Scalar)]
    numbers = tuple(value for value in values if type(value) is int)
    if not numbers or len(numbers) != len(values):
        reader.problem("wrong-kind", f"{name} of {reader.what} must be a list of whole numbers")
    return numbers


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
