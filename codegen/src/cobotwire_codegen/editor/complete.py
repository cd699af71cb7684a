"""Completes keys, words of closed lists, and names that the spec defines."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from cobotwire_codegen.editor.context import context_at
from cobotwire_codegen.language.shapes import Known, Word, YesNo
from cobotwire_codegen.model import Edition
from cobotwire_codegen.units import UNITS

# Keys with names of commands, types and vectors as values.
_COMMANDS = {"command", "commands", "change", "remove", "rename", "alias", "shares_id", "except"}
_COMMANDS |= {"agrees_with", "withdraw_acks"}


class Completion(NamedTuple):
    """One proposal: the text to insert, and what it means."""

    label: str
    doc: str
    is_key: bool = False


def completions(edition: Edition | None, text: str, line: int, column: int) -> list[Completion]:
    """Return the proposals for a position of a text; lines and columns count from 0."""
    context = context_at(text, line, column)
    if not context.value_of:
        return [Completion(name, key.doc, is_key=True) for name, key in context.keys.items()]
    shape = context.shape
    if isinstance(shape, Word):
        docs = shape.docs or ("",) * len(shape.known)
        return [Completion(word, doc) for word, doc in zip(shape.known, docs)]
    if isinstance(shape, YesNo):
        return [Completion("true", ""), Completion("false", "")]
    if context.value_of == "unit":
        return [Completion(name, unit.symbol) for name, unit in UNITS.items()]
    return [] if edition is None else list(_names(edition, context.value_of, shape))


def _names(edition: Edition, key: str, shape: object) -> Iterator[Completion]:
    if key in ("wire",):
        yield from (Completion(wire.name, wire.doc) for wire in edition.wires)
    elif key in _COMMANDS:
        yield from (Completion(command.name, command.title) for command in edition.commands)
    elif key == "withdraw":
        yield from (Completion(vector.name, vector.command) for vector in edition.vectors)
    elif isinstance(shape, Known) or key == "change_type":
        yield from (Completion(type.name, type.doc) for type in edition.types)
