"""Parses YAML to nodes that know their place. The only importer of the YAML library."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.nodes import MappingNode, ScalarNode, SequenceNode
from ruamel.yaml.nodes import Node as YamlNode
from ruamel.yaml.reader import ReaderError

from cobotwire_codegen.errors import Place, Problem, SpecError

Plain = str | int | bool | Fraction | None

_TAG = "tag:yaml.org,2002:"
_EXPONENT = re.compile(r"[eE]([+-]?\d+)")


@dataclass(frozen=True, slots=True)
class Scalar:
    """A text, number, truth value or nothing. Decimal numbers are kept exact."""

    place: Place
    value: Plain


@dataclass(frozen=True, slots=True)
class Sequence:
    """A list."""

    place: Place
    items: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Mapping:
    """A mapping; ``keys`` holds the place of each key."""

    place: Place
    entries: dict[str, Node]
    keys: dict[str, Place] = field(default_factory=dict)


Node = Scalar | Sequence | Mapping


def load(path: Path, shown: str | None = None) -> Node:
    """Return the root node of a YAML file; ``shown`` is the file's name in messages.

    Raises:
        SpecError: the file is missing, is not YAML, or gives a key twice.
    """
    name = shown if shown is not None else str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise SpecError([Problem(Place(name, 1, 1), "unreadable", reason)]) from error
    return parse(text, name)


def parse(text: str, name: str) -> Node:
    """Return the root node of YAML text; ``name`` stands for the file in messages."""
    problems: list[Problem] = []
    try:
        root = YAML(typ="safe", pure=True).compose(text)
        node = None if root is None else _convert(root, name, problems, ())
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = Place(name, mark.line + 1, mark.column + 1) if mark else Place(name, 1, 1)
        raise SpecError([Problem(place, "syntax", error.problem or "not YAML")]) from error
    except ReaderError as error:
        before = text[: error.position]
        column = error.position - (before.rfind("\n") + 1) + 1
        place = Place(name, before.count("\n") + 1, column)
        message = f"the character U+{ord(text[error.position]):04X} is not allowed in YAML"
        raise SpecError([Problem(place, "syntax", message)]) from error
    except RecursionError:
        raise SpecError([Problem(Place(name, 1, 1), "syntax", "nested too deeply")]) from None
    if problems:
        raise SpecError(problems)
    return node if node is not None else Scalar(Place(name, 1, 1), None)


def _convert(
    node: YamlNode, name: str, problems: list[Problem], above: tuple[YamlNode, ...]
) -> Node:
    place = Place(name, node.start_mark.line + 1, node.start_mark.column + 1)
    if any(node is outer for outer in above):
        problems.append(Problem(place, "syntax", "an alias refers to a node that contains it"))
        return Scalar(place, None)
    above = (*above, node)
    if isinstance(node, ScalarNode):
        return _scalar(node, place, problems)
    if isinstance(node, SequenceNode):
        items = tuple(_convert(item, name, problems, above) for item in node.value)
        return Sequence(place, items)
    if isinstance(node, MappingNode):
        return _mapping(node, place, name, problems, above)
    raise AssertionError(f"{place}: unknown kind of node {node!r}")


def _mapping(
    node: MappingNode,
    place: Place,
    name: str,
    problems: list[Problem],
    above: tuple[YamlNode, ...],
) -> Mapping:
    mapping = Mapping(place, {})
    for key_node, value in node.value:
        key_place = Place(name, key_node.start_mark.line + 1, key_node.start_mark.column + 1)
        if not isinstance(key_node, ScalarNode):
            problems.append(Problem(key_place, "bad-key", "a key must be a plain word"))
            continue
        key = key_node.value
        if key in mapping.entries:
            first = mapping.keys[key]
            problems.append(
                Problem(key_place, "duplicate-key", f"{key} is already given in line {first.line}")
            )
            continue
        mapping.entries[key] = _convert(value, name, problems, above)
        mapping.keys[key] = key_place
    return mapping


def _scalar(node: ScalarNode, place: Place, problems: list[Problem]) -> Scalar:
    text, tag = node.value, str(node.tag).removeprefix(_TAG)
    if tag == "bool":
        return Scalar(place, text.lower() == "true")
    if tag == "null":
        return Scalar(place, None)
    if tag in ("int", "float"):
        try:
            return Scalar(place, _whole(text) if tag == "int" else exact(text))
        except ValueError:
            shown = text if len(text) <= 40 else f"{text[:37]}..."
            message = f"{shown} is not a number with an exact value"
            problems.append(Problem(place, "bad-number", message))
            return Scalar(place, None)
    if tag != "str":
        problems.append(Problem(place, "bad-tag", f"the tag {node.tag} is not supported"))
    return Scalar(place, text)


def exact(text: str) -> Fraction:
    """Return the exact value of a number; a number with a huge exponent is rejected.

    Raises:
        ValueError: the text is not a number, or its exponent has more than three digits.
    """
    exponent = _EXPONENT.search(text)
    # 1e99999999 would be computed digit by digit.
    if exponent is not None and len(exponent[1].lstrip("+-0")) > 3:
        raise ValueError(text)
    return Fraction(text)


def _whole(text: str) -> int:
    """Return a whole number as YAML 1.2 reads it: a leading 0 does not mean octal."""
    digits = text.replace("_", "")
    bases = {"0x": 16, "0o": 8, "0b": 2}
    return int(digits, bases.get(digits.lstrip("+-")[:2].lower(), 10))
