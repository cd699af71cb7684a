"""Parses YAML to nodes that know their place. Only it and ``c_parser`` import the YAML library."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.nodes import MappingNode, ScalarNode, SequenceNode
from ruamel.yaml.nodes import Node as YamlNode
from ruamel.yaml.reader import ReaderError

from cobotwire_codegen.c_parser import plain_root
from cobotwire_codegen.errors import Place, Problem, SpecError
from cobotwire_codegen.legal import odd_character
from cobotwire_codegen.yaml_words import Mistake, Spot, explained

Plain = str | int | bool | Fraction | None

_TAG = "tag:yaml.org,2002:"
_EXPONENT = re.compile(r"[eE]([+-]?\d+)")

# The limits of one file, and of all files of an edition and its bases together. The largest spec
# needs a small part of them. Aliases count as often as they are used, and so do files, since every
# use is read.
MOST_BYTES = 2 * 1024 * 1024
MOST_NODES = 200_000
MOST_BYTES_TOGETHER = 2 * MOST_BYTES
MOST_NODES_TOGETHER = 2 * MOST_NODES
DEEPEST = 40
LONGEST_NUMBER = 100


@dataclass(frozen=True, slots=True)
class Scalar:
    """A text, number, truth value or nothing. Decimal numbers are kept exact.

    ``text`` is a number as written: the number ``0x55`` is 85, but where bytes are expected it is
    an error.
    """

    place: Place
    value: Plain
    text: str = ""


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


class Parsed(NamedTuple):
    """The root node of a text, and the size of the text: its bytes and its values."""

    root: Node
    bytes: int
    nodes: int


def load(path: Path, shown: str | None = None) -> Node:
    """Return the root node of a YAML file; see :func:`loaded`."""
    return loaded(path, shown).root


def loaded(path: Path, shown: str | None = None) -> Parsed:
    """Return the content of a YAML file; ``shown`` is the file's name in messages.

    Raises:
        SpecError: the file is missing, is not YAML, gives a key twice, or exceeds a limit.
    """
    name = shown if shown is not None else str(path)
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        reason = error.strerror or str(error)
        raise SpecError([Problem(Place(name, 1, 1), "unreadable", reason)]) from error
    return parsed(_decoded(data, name), name)


def _decoded(data: bytes, name: str) -> str:
    try:
        return data.decode()
    except UnicodeDecodeError as error:
        if len(data) > MOST_BYTES:
            return " " * len(data)  # cut inside a character; ``parsed`` reports the size
        before = data[: error.start].decode()
        message = f"the byte {data[error.start]:02X} is not UTF-8; save the file as UTF-8"
        raise SpecError([Problem(_at(before, name), "unreadable", message)]) from error


def _at(before: str, name: str) -> Place:
    """Return the place that follows a text."""
    return Place(name, before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1)


def parse(text: str, name: str) -> Node:
    """Return the root node of YAML text; see :func:`parsed`."""
    return parsed(text, name).root


@lru_cache(maxsize=256)
def parsed(text: str, name: str) -> Parsed:
    """Return the content of YAML text; ``name`` stands for the file in messages.

    Parsing takes most of the time of a build, and the files of a base are read again for each of
    its deltas. So equal text gets the same nodes, which must not be changed.

    Raises:
        SpecError: the text is not YAML, gives a key twice, or exceeds a limit.
    """
    size = len(text.encode(errors="replace"))
    if size > MOST_BYTES:
        message = f"the file has more than {MOST_BYTES} bytes, the limit; divide it"
        raise SpecError([Problem(Place(name, 1, 1), "too-large", message)])
    converter = _Converter(name)
    try:
        root = plain_root(text, DEEPEST) or _yaml().compose(text)
        node = None if root is None else converter.node(root, ())
    except MarkedYAMLError as error:
        raise SpecError([_syntax(error, text, name)]) from error
    except ReaderError as error:
        message = f"the character U+{ord(text[error.position]):04X} is not allowed in YAML"
        place = _at(text[: error.position], name)
        raise SpecError([Problem(place, "syntax", message)]) from error
    except RecursionError:
        raise SpecError([_too_deep(Place(name, 1, 1))]) from None
    if converter.problems:
        raise SpecError(converter.problems)
    return Parsed(node or Scalar(Place(name, 1, 1), None), size, converter.nodes)


def _yaml() -> YAML:
    yaml = YAML(typ="safe", pure=True)
    yaml.max_depth = DEEPEST
    return yaml


def _too_deep(place: Place) -> Problem:
    return Problem(place, "too-large", f"this is nested more than {DEEPEST} deep, the limit")


def _syntax(error: MarkedYAMLError, text: str, name: str) -> Problem:
    """Return the problem of a file that is not YAML, at the place that has to be corrected."""
    began, failed = _spot(error.context_mark), _spot(error.problem_mark)
    if "maximum depth" in (error.problem or ""):
        line, column = failed or (0, 0)
        return _too_deep(Place(name, line + 1, column + 1))
    mistake = Mistake(error.context or "", error.problem or "", began, failed)
    (line, column), message = explained(mistake, _quote_before(text, failed))
    return Problem(Place(name, line + 1, column + 1), "syntax", message)


def _spot(mark: Any) -> Spot | None:
    return None if mark is None else (mark.line, mark.column)


def _quote_before(text: str, failed: Spot | None) -> tuple[Spot, Spot] | None:
    """Return the quoted text of several lines that ends in the line of a mistake, if there is one.

    If a closing quote is missing, the text ends at the next quote of a later line, and what
    follows there makes no sense.
    """
    found = None
    try:
        for token in _yaml().scan(text):
            first, last = _spot(token.start_mark), _spot(token.end_mark)
            if failed is not None and first is not None and first > failed:
                break
            if first and last and failed and getattr(token, "style", None) in ("'", '"'):
                inside = first[0] < last[0] == failed[0]
                found = (first, last) if inside else None
    except MarkedYAMLError:
        pass
    return found


class _Converter:
    """Turns the library's nodes into nodes with places, and collects the problems."""

    def __init__(self, name: str) -> None:
        self.problems: list[Problem] = []
        self._name = name
        self.nodes = 0

    def node(self, node: YamlNode, above: tuple[YamlNode, ...]) -> Node:
        """Return a node with everything in it; ``above`` are the nodes that contain it."""
        place = self._place(node)
        self.nodes += 1
        if self.nodes > MOST_NODES:
            message = (
                f"up to here the file has more than {MOST_NODES} values, the limit; each use of "
                "an alias counts"
            )
            raise SpecError([Problem(place, "too-large", message)])
        if any(node is outer for outer in above):
            message = "an alias refers to a node that contains it"
            self.problems.append(Problem(place, "syntax", message))
            return Scalar(place, None)
        above = (*above, node)
        if len(above) > DEEPEST:
            raise SpecError([_too_deep(place)])
        if isinstance(node, ScalarNode):
            return _scalar(node, place, self.problems)
        if isinstance(node, SequenceNode):
            return Sequence(place, tuple(self.node(item, above) for item in node.value))
        if isinstance(node, MappingNode):
            return self._mapping(node, place, above)
        raise AssertionError(f"{place}: unknown kind of node {node!r}")

    def _place(self, node: YamlNode) -> Place:
        return Place(self._name, node.start_mark.line + 1, node.start_mark.column + 1)

    def _mapping(self, node: MappingNode, place: Place, above: tuple[YamlNode, ...]) -> Mapping:
        mapping = Mapping(place, {})
        for key_node, value in node.value:
            key_place = self._place(key_node)
            wrong = _wrong_key(key_node, key_place, mapping)
            if wrong is not None:
                self.problems.append(wrong)
                continue
            mapping.entries[key_node.value] = self.node(value, above)
            mapping.keys[key_node.value] = key_place
        return mapping


def _wrong_key(node: YamlNode, place: Place, mapping: Mapping) -> Problem | None:
    """Return the problem of a key that cannot be added to a mapping, or None."""
    if not isinstance(node, ScalarNode):
        return Problem(place, "bad-key", "a key must be a plain word")
    if str(node.tag) == f"{_TAG}merge":
        message = (
            "merge keys (<<) are not supported; write the keys here, or use an alias for a whole "
            "value (key: *anchor)"
        )
        return Problem(place, "bad-key", message)
    if node.value in mapping.entries:
        line = mapping.keys[node.value].line
        return Problem(place, "duplicate-key", f"{node.value} is already given in line {line}")
    odd = odd_character(node.value)
    return Problem(place, "bad-character", f"the key contains {odd}") if odd else None


def _scalar(node: ScalarNode, place: Place, problems: list[Problem]) -> Scalar:
    text, tag = node.value, str(node.tag).removeprefix(_TAG)
    odd = odd_character(text)
    if odd:
        problems.append(Problem(place, "bad-character", f"the value contains {odd}"))
        return Scalar(place, None)
    if tag == "bool":
        return Scalar(place, text.lower() == "true")
    if tag == "null":
        return Scalar(place, None)
    if tag in ("int", "float"):
        return Scalar(place, _number(text, tag, place, problems), text)
    if tag != "str":
        problems.append(Problem(place, "bad-tag", f"the tag {node.tag} is not supported"))
    return Scalar(place, text)


def _number(text: str, tag: str, place: Place, problems: list[Problem]) -> Plain:
    shown = text if len(text) <= 40 else f"{text[:37]}..."
    if len(text) > LONGEST_NUMBER:
        message = f"the number {shown} has more than {LONGEST_NUMBER} characters, the limit"
        problems.append(Problem(place, "bad-number", message))
        return None
    try:
        return _whole(text) if tag == "int" else exact(text)
    except ValueError:
        message = f"{shown} is not a number with an exact value"
        problems.append(Problem(place, "bad-number", message))
        return None


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
