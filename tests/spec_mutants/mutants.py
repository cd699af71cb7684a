"""Changes one fact: each kind of value has its own wrong values."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, NamedTuple

from cobotwire_codegen.language import Command, RequestText
from cobotwire_codegen.language.number_shapes import (
    Exact,
    Numbers,
    Range,
    Ranges,
    Real,
    Reals,
    Whole,
    as_fraction,
)
from cobotwire_codegen.language.shapes import (
    Anything,
    Hex,
    Known,
    Names,
    Shape,
    Text,
    Word,
    YesNo,
)
from cobotwire_codegen.language.words import BUILT_IN
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence
from cobotwire_codegen.model import Edition, Quantity, Type
from spec_mutants.facts import Fact, Path, changed, facts_of, with_value

# A list with more words is reduced to the nearest ones.
MOST_WORDS = 6
# The keys whose values name state.
STATED_STATES = ("reports.reports", "stores.stores")
Wrong = Iterator[tuple[str, Node | None]]


class Mutant(NamedTuple):
    """A file with one fact changed; ``name`` says which fact, and how."""

    kind: str
    name: str
    path: Path
    new: Node | None

    def applied(self, root: Node) -> Node:
        """Return the changed file."""
        return changed(root, self.path, self.new)


def mutants_of(root: Node, edition: Edition) -> Iterator[Mutant]:
    """Yield the mutants of a file of an edition."""
    for fact in facts_of(root):
        where = ".".join(map(str, fact.path))
        if fact.removable:
            yield Mutant(fact.kind, f"{where}: left out", fact.path, None)
        for what, node in _wrong(fact, edition):
            yield Mutant(fact.kind, f"{where}: {what}", fact.path, node)


def _wrong(fact: Fact, edition: Edition) -> Wrong:
    shape, node = fact.shape, fact.node
    if fact.kind in STATED_STATES:
        yield from _states(node, edition)
    elif fact.kind.endswith(".samples"):
        yield from _each_number(node, Numbers())
    elif isinstance(shape, Range | Ranges | Reals | Numbers) and isinstance(node, Sequence):
        yield from _each_number(node, shape)
    elif isinstance(shape, Names):
        yield from _names(fact, edition)
    elif isinstance(node, Scalar):
        for value in _values(shape, node, edition):
            yield f"{node.value} -> {value}", with_value(node, value)


def _values(shape: Shape[Any] | None, node: Scalar, edition: Edition) -> Iterator[Any]:
    """Yield wrong values for a plain value."""
    number = as_fraction(node)
    if isinstance(shape, Known):
        yield from _types(shape, str(node.value), edition)
    elif isinstance(shape, YesNo):
        yield not node.value
    elif isinstance(shape, Word):
        yield from _words(shape, str(node.value))
    elif isinstance(shape, Hex):
        data = bytes.fromhex(str(node.value))
        for index in range(len(data)):
            wrong = bytes([*data[:index], data[index] ^ 1, *data[index + 1 :]])
            yield wrong.hex(" ").upper()
    elif isinstance(shape, Whole) and number is not None:
        yield from (int(number) + 1, int(number) - 1)
    elif isinstance(shape, Exact) and number is not None:
        yield from (str(number * 10), str(number / 10))
    elif isinstance(shape, Real) and number is not None:
        yield number + 1
        if number:
            yield -number
    elif isinstance(shape, Anything) and isinstance(node.value, bool):
        yield not node.value
    elif isinstance(shape, Anything) and number is not None:
        yield int(number) + 1
    elif shape is RequestText.text.shape or isinstance(shape, Text):
        yield from _texts(str(node.value), edition)


def _texts(text: str, edition: Edition) -> Iterator[str]:
    """Yield a text with another character, or the name of another command or argument."""
    if any(command.name == text for command in edition.commands):
        yield next(command.name for command in edition.commands if command.name != text)
    elif text in _arguments(edition):
        yield from _near(text, _arguments(edition))
    elif "{" in text:
        yield text.replace("{", "x{", 1)


def _words(shape: Word, given: str) -> Iterator[str]:
    others = [word for word in shape.known if word != given]
    if len(shape.known) <= MOST_WORDS:
        yield from others
    else:
        at = shape.known.index(given)
        yield from {shape.known[at - 1]: 0, shape.known[(at + 1) % len(shape.known)]: 0}


def _types(shape: Known, given: str, edition: Edition) -> Iterator[str]:
    """Yield the two types that differ least from a type and need as many bytes."""
    if shape.definition == "wire_name":
        yield from [wire.name for wire in edition.wires if wire.name != given][:2]
    else:
        key = (edition.name, shape.definition, given)
        if key not in _NEAREST:
            _NEAREST[key] = _nearest(shape, given, edition)
        yield from _NEAREST[key]


_NEAREST: dict[tuple[str, str, str], list[str]] = {}


def _nearest(shape: Known, given: str, edition: Edition) -> list[str]:
    types = {type.name: type for type in edition.types}
    if shape.definition == "quantity_name":
        types = {name: type for name, type in types.items() if isinstance(type, Quantity)}
    if given not in types:
        return []
    facts = _facts_of_type(types[given])
    others = []
    for name, type in types.items():
        theirs = _facts_of_type(type)
        if type.size == types[given].size and theirs != facts:
            alike = sum(a == b for a, b in zip(facts, theirs))
            others.append((-alike, name))
    return [name for _, name in sorted(others)[:2]]


def _facts_of_type(type: Type) -> tuple[object, ...]:
    """Return what is observable of a type, in any fixed order."""
    members = tuple((member.name, member.value) for member in type.members)
    parts = [
        (label, part.wire.name, part.scale, part.unit, part.choices)
        + ((part.bounds, part.radians) if isinstance(part, Quantity) else ())
        for label, part in type.parts
    ]
    return (type.kind, type.class_name, members, *(tuple(column) for column in zip(*parts)))


def _each_number(node: Node, shape: Shape[Any], at: str = "") -> Wrong:
    """Yield a list or mapping with one of its numbers a step lower or higher."""
    step = Fraction(1, 10) if isinstance(shape, Range) and _has_fraction(node) else Fraction(1)
    for path, number in _numbers(node):
        for wrong in (number - step, number + step):
            value: Any = int(wrong) if wrong.denominator == 1 else wrong
            yield f"{number} -> {wrong} at {path}", changed(node, path, Scalar(node.place, value))


def _has_fraction(node: Node) -> bool:
    return any(number.denominator != 1 for _, number in _numbers(node))


def _numbers(node: Node, path: Path = ()) -> Iterator[tuple[Path, Fraction]]:
    if isinstance(node, Scalar):
        number = as_fraction(node)
        if number is not None:
            yield path, number
    elif isinstance(node, Sequence):
        for index, item in enumerate(node.items):
            yield from _numbers(item, (*path, index))
    else:
        for name, item in node.entries.items():
            yield from _numbers(item, (*path, name))


def _queries(edition: Edition) -> list[str]:
    return [command.name for command in edition.commands if command.safety == "query"]


def _near(given: str, names: list[str]) -> list[str]:
    """Return the neighbours of a name in a list that contains it."""
    if given not in names:
        return names[:1]
    at = names.index(given)
    return list({names[at - 1]: 0, names[(at + 1) % len(names)]: 0})


def _states(node: Node, edition: Edition) -> Wrong:
    """Yield effects that report or store another state: a neighbour, or one of the same type."""
    if isinstance(node, Mapping):
        for name, inner in node.entries.items():
            for what, wrong in _states(inner, edition):
                yield f"{name}: {what}", changed(node, (name,), wrong)
    elif isinstance(node, Scalar):
        given = str(node.value)
        types = {state.name: state.type for state in edition.states} | dict.fromkeys(BUILT_IN)
        alike = [name for name, type in types.items() if type == types.get(given) and name != given]
        for name in dict.fromkeys([*_near(given, list(types)), *alike[:2]]):
            yield f"{given} -> {name}", with_value(node, name)


def _arguments(edition: Edition) -> list[str]:
    given = (field.name for c in edition.commands for variant in c.requests for field in variant)
    return list(dict.fromkeys(given))


def _names(fact: Fact, edition: Edition) -> Wrong:
    """Yield a list of names with one name left out, or replaced by another of its kind."""
    node = fact.node
    named = [command.name for command in edition.commands]
    known = _queries(edition) if fact.kind.endswith(Command.agrees_with.name) else named
    if fact.kind == "state.each":
        named = known = [type.name for type in edition.types]
    elif fact.kind.endswith(".at"):
        named = known = _arguments(edition)
    items = node.items if isinstance(node, Sequence) else (node,)
    for index, item in enumerate(items):
        assert isinstance(item, Scalar)
        path: Path = (index,) if isinstance(node, Sequence) else ()
        if isinstance(node, Sequence):
            yield f"without {item.value}", changed(node, path, None)
        if item.value in named:
            for name in _near(str(item.value), known)[:1]:
                new = with_value(item, name)
                yield f"{item.value} -> {name}", changed(node, path, new) if path else new
