"""Describes the arguments of a method, in its order, and their legal combinations."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from cobotwire_codegen.model import (
    Command,
    Enum,
    Field,
    Flag,
    Quantity,
    Type,
    Value,
    Variant,
    named_fields,
)
from cobotwire_codegen.render.by_identity import by_identity
from cobotwire_codegen.render.parameters import Parameter, argument_type, parameters
from cobotwire_codegen.render.words import decimal


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a method: its annotation, and its default as text, empty if it has none."""

    name: str
    annotation: str
    default: str
    doc: str

    @property
    def declaration(self) -> str:
        """The argument in the head of a method, or the attribute in the body of a class."""
        default = f" = {self.default}" if self.default else ""
        return f"{self.name}: {self.annotation}{default}"


@by_identity
def arguments(command: Command) -> tuple[Argument, ...]:
    """Return all arguments of a method in their order."""
    fields = {parameter.name: parameter for parameter in parameters(command)}
    return tuple(
        _of_field(fields[name]) if name in fields else _of_text(command, name)
        for name in command.argument_names
    )


@by_identity
def overloads(command: Command) -> tuple[tuple[Argument, ...], ...]:
    """Return the arguments of each variant; empty if one signature covers all variants.

    One signature suffices if each variant adds one argument to the next shorter variant, and each
    argument has the same type in all variants.
    """
    found = parameters(command)
    names = sorted((set(named_fields((v,))) for v in command.requests), key=len)
    steps = pairwise(names)
    chain = all(short < long and len(long) == len(short) + 1 for short, long in steps)
    if chain and all(len({_annotation(field) for field in p.fields}) == 1 for p in found):
        return ()
    return tuple(_of_variant(command, variant) for variant in command.requests)


def keyword_only(command: Command) -> set[str]:
    """Return the keyword-only arguments: those that some overload lacks, if there are several."""
    if not overloads(command):
        return set()
    return {parameter.name for parameter in parameters(command) if parameter.may_be_none}


def default_in_words(field: Field) -> str:
    """Return a field's default as the docs show it; empty if it has none."""
    return "" if field.default is None else _in_words(field.type, field.default)


def constant_in_words(field: Field) -> str:
    """Return a field's constant as the docs show it; empty if it has none."""
    return "" if field.const is None else _in_words(field.type, (field.const,))


def _in_words(type: Type, raw: tuple[int, ...]) -> str:
    if isinstance(type, Enum):
        return f"{type.from_raw(raw[0])} ({raw[0]})"
    if isinstance(type, Flag):
        return str(raw == (1,))
    numbers = [decimal(_exact(part, each)) for each, (_, part) in zip(raw, type.parts)]
    return f"({', '.join(numbers)})" if isinstance(type, Value) else numbers[0]


def python_value(type: Type, raw: tuple[int, ...], *, on_wire: bool = False) -> str:
    """Return raw values as a Python expression, in the units of the API or else of the wire."""
    parts = [_number(part, each, on_wire) for each, (_, part) in zip(raw, type.parts)]
    if isinstance(type, Value):
        return f"({parts[0]},)" if len(parts) == 1 else f"({', '.join(parts)})"
    return str(raw == (1,)) if isinstance(type, Flag) and not on_wire else parts[0]


def _number(part: Type, raw: int, on_wire: bool) -> str:
    if not isinstance(part, Quantity):
        return str(raw)
    exact = _exact(part, raw)
    if part.radians and not on_wire:
        return repr(math.radians(exact))
    return repr(float(exact)) if part.real else str(exact)


def _exact(part: Type, raw: int) -> Fraction:
    """Return the physical value of a raw value."""
    value = part.from_raw(raw) if isinstance(part, Quantity) else raw
    assert isinstance(value, int | Fraction), "a quantity is a number"
    return Fraction(value)


def _annotation(field: Field) -> str:
    return argument_type(Parameter(field.name, (field,), optional=False))


def _of_field(parameter: Parameter) -> Argument:
    default = "None" if parameter.may_be_none else ""
    if parameter.default is not None:
        default = python_value(parameter.fields[0].type, parameter.default)
    return Argument(parameter.name, argument_type(parameter), default, _line(parameter))


def _line(parameter: Parameter) -> str:
    """Return a parameter's line of the docstring: its description, range, unit and default."""
    allowed = parameter.allowed
    if parameter.radians:
        allowed = f"in radians; on the wire {allowed}"
    shown = dict.fromkeys(filter(None, map(default_in_words, parameter.fields)))
    if shown:
        allowed += f"; default: {' or '.join(shown)}"
    elif parameter.optional:
        allowed += "; optional"
    return f"{parameter.name}: {parameter.doc.removesuffix('.')} ({allowed})."


def _of_text(command: Command, name: str) -> Argument:
    docs = dict(command.request_text.fields) if command.request_text else {}
    return Argument(name, "str", "", f"{name}: {docs.get(name, '').removesuffix('.')} (ASCII).")


def _of_variant(command: Command, variant: Variant) -> tuple[Argument, ...]:
    given = (field for field in variant if field.const is None and not field.counts)
    fields = {field.name: field for field in given}
    texts = command.text_arguments
    return tuple(
        _of_field(Parameter(name, (fields[name],), optional=False))
        if name in fields
        else _of_text(command, name)
        for name in command.argument_names
        if name in fields or name in texts
    )
