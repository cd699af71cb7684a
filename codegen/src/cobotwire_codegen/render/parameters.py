"""Derives the arguments and results of a method from the fields of all variants of a message."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Command,
    Field,
    Listed,
    Quantity,
    Type,
    Variant,
    named_fields,
)
from cobotwire_codegen.render.words import allowed


@dataclass(frozen=True, slots=True)
class Parameter:
    """An argument or a result; ``fields`` are the fields of that name, one for each variant."""

    name: str
    fields: tuple[Field, ...]
    optional: bool

    @property
    def types(self) -> tuple[Type, ...]:
        """Every type that it can have, each once."""
        # One object is compared by its identity first, because hashing a type takes long.
        found = {id(type): type for field in self.fields for _, type in lower.cases(field)}
        return tuple(found.values()) if len(found) == 1 else tuple(dict.fromkeys(found.values()))

    @property
    def doc(self) -> str:
        """The description in the spec."""
        return self.fields[0].doc

    @property
    def allowed(self) -> str:
        """The allowed values, in words."""
        return " or ".join(dict.fromkeys(allowed(field) for field in self.fields))

    @property
    def default(self) -> tuple[int, ...] | None:
        """The raw values that all variants use if the argument is left out; None: they differ."""
        [*defaults] = {field.default for field in self.fields}
        return defaults[0] if len(defaults) == 1 and not self.optional else None

    @property
    def may_be_none(self) -> bool:
        """Whether None says that the argument is left out."""
        with_default = any(field.default is not None for field in self.fields)
        return self.default is None and (self.optional or with_default)

    @property
    def radians(self) -> bool:
        """Whether the API uses radians where the wire carries degrees."""
        return any(_radians(type) for type in self.types)


def parameters(command: Command) -> list[Parameter]:
    """Return the arguments of a command that are fields, in the order of its method."""
    found = {parameter.name: parameter for parameter in _by_name(command.requests)}
    order = command.argument_names
    # A name that the order lacks is a problem that the checker reports.
    return [found[name] for name in dict.fromkeys((*order, *found)) if name in found]


def results(command: Command) -> list[Parameter]:
    """Return the fields of every variant of the reply, without those that repeat an argument.

    If no field is in every variant, return all fields; each of them may be absent.
    """
    if command.ack:
        return []
    found = _by_name(command.replies)
    reported = [p for p in found if not any(field.echo for field in p.fields)]
    return [p for p in reported if not p.optional] or reported


def reply_parameters(command: Command) -> list[Parameter]:
    """Return every field of the reply that is not a constant, by name."""
    return _by_name(command.replies)


def _by_name(variants: tuple[Variant, ...]) -> list[Parameter]:
    return [
        Parameter(name, fields, len(fields) < len(variants))
        for name, fields in named_fields(variants).items()
    ]


def _radians(type: Type) -> bool:
    return any(isinstance(part, Quantity) and part.radians for _, part in type.parts)


def argument_type(parameter: Parameter) -> str:
    """Return the annotation of an argument."""
    words = dict.fromkeys(_argument(type) for type in parameter.types)
    if set(words) == {"int", "float"}:
        words = {"float": None}
    return " | ".join([*words, *(["None"] if parameter.may_be_none else [])])


def _argument(type: Type) -> str:
    if isinstance(type, Listed):
        return f"Sequence[{_argument(type.of)}]"
    if type.items:
        return f"Sequence[{type.scalar}]"
    return f"{type.class_name} | {type.scalar}" if type.class_name else type.scalar


def result_type(parameter: Parameter) -> str:
    """Return the annotation of a result."""
    first = parameter.types[0]
    if len(parameter.types) == 1:
        if isinstance(first, Listed):
            return f"tuple[{element_type(first.of)}, ...]"
        return element_type(first)
    words = {type.scalar for type in parameter.types}
    word = words.pop() if len(words) == 1 else "float"
    return f"tuple[{word}, ...]" if first.items else word


def element_type(type: Type) -> str:
    """Return the annotation of an element of a list, or of a part of a named tuple."""
    return type.class_name or type.scalar


def returns(command: Command) -> str:
    """Return the annotation of what the method returns."""
    found = results(command)
    if command.text is not None:
        return command.text.class_name
    if not found:
        return "None"
    return reported_type(found[0]) if len(found) == 1 else result_class(command)


def reported_type(result: Parameter) -> str:
    """Return the annotation of a result, which is None if the reply is a variant without it."""
    return result_type(result) + (" | None" if result.optional else "")


def result_class(command: Command) -> str:
    """Return the name of the named tuple for a reply with several results."""
    return f"{lower.message_class(command.name)}Result"
