"""Describes the message classes of a command; the template writes them, editions share them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

from cobotwire_codegen.lower import message_class
from cobotwire_codegen.model import Command, Field, Listed, Type, Variant
from cobotwire_codegen.render.arguments import (
    Argument,
    arguments,
    keyword_only,
    overloads,
    python_value,
)
from cobotwire_codegen.render.layout import laid_out
from cobotwire_codegen.render.literal import Name, literal
from cobotwire_codegen.render.parameters import (
    Parameter,
    argument_type,
    parameters,
    reply_parameters,
    result_class,
    result_type,
    results,
    returns,
)


@dataclass(frozen=True, slots=True)
class MessageClass:
    """A class of the generated ``messages``; ``fields`` are its annotations, as text."""

    name: str
    parts: tuple[str, ...]
    """The base class and the keywords."""
    doc: str
    fields: tuple[str, ...]
    constructors: tuple[str, ...] = ()
    """The heads of the constructor, one for each variant; empty if the fields define it."""

    @property
    def head(self) -> str:
        """The head of the class, up to its colon."""
        return laid_out(f"class {self.name}(", list(self.parts), "):", 0)


def message_classes(command: Command) -> tuple[MessageClass, ...]:
    """Return the class of the request, and the class of the reply if there is one."""
    if command.event:
        return (_event(command),)
    if not command.replies and command.text is None:
        return (_request(command),)
    return _request(command), _reply(command)


def _request(command: Command) -> MessageClass:
    given = arguments(command)
    text = command.text_arguments
    keywords = [f'command="{command.name}"']
    names = tuple(argument.name for argument in given if argument.name not in text)
    rows = [_row_of(variant) for variant in command.requests]
    keywords += _layout(rows, names, _are_prefixes(command))
    keywords += _radians(parameters(command))
    if text:
        keywords.append(f"text={_row(map(_quoted, text))}")
    return MessageClass(
        message_class(command.name),
        (f"Request[{returns(command)}]", *keywords),
        f"{command.title}.",
        tuple(argument.declaration for argument in given),
        tuple(constructor(command, variant) for variant in overloads(command)),
    )


def _are_prefixes(command: Command) -> bool:
    """Return whether the number of values decides the variant of a request."""
    rows = sorted((_row_of(variant) for variant in command.requests), key=len)
    plain = all(field.default is None for variant in command.requests for field in variant)
    steps = pairwise(rows)
    return (plain or len(rows) == 1) and all(
        len(short) < len(long)
        and long[: len(short)] == short
        and all(part.startswith('"') for part in long[len(short) :])
        for short, long in steps
    )


def _are_shortened(rows: list[tuple[str, ...]]) -> bool:
    """Return whether a reply has one variant, or a second one that only leaves fields out."""
    different = sorted(set(rows), key=len)
    if len(different) <= 1:
        return True
    short, long = different[0], different[-1]
    left_out = [part for part in long if part not in short]
    kept = tuple(part for part in long if part in short)
    return len(different) == 2 and kept == short and all(p.startswith('"') for p in left_out)


def constructor(command: Command, variant: tuple[Argument, ...]) -> str:
    """Return the head of a request's constructor for the arguments of one variant."""
    return laid_out("def __init__(", declared(command, variant), ") -> None: ...", 8)


def declared(command: Command, given: tuple[Argument, ...]) -> list[str]:
    """Return the arguments of a method's head; those without a position come after a star."""
    named = keyword_only(command)
    placed = [argument.declaration for argument in given if argument.name not in named]
    others = [argument.declaration for argument in given if argument.name in named]
    return ["self", *placed, *(["*", *others] if others else [])]


def _reply(command: Command) -> MessageClass:
    found = results(command)
    every = reply_parameters(command)
    needed = [result for result in found if not result.optional]
    others = [parameter for parameter in every if parameter not in needed]
    fields = [f"{result.name}: {result_type(result)}" for result in needed]
    fields += [f"{other.name}: {result_type(other)} | None = None" for other in others]
    keywords = [f"to={message_class(command.name)}"]
    if command.text is not None:
        names = [name for name, _ in command.text.fields]
        fields = [f"{name}: str" for name in names]
        keywords.append(f"result={command.text.class_name}")
        keywords.append(f"text={_row(map(_quoted, names))}")
    elif len(found) > 1:
        keywords.append(f"result={result_class(command)}")
    if found and not needed:
        keywords.append(f"results={_row(_quoted(result.name) for result in found)}")
    rows = [_row_of(variant) for variant in command.replies]
    keywords += _layout(rows, tuple(p.name for p in (*needed, *others)), _are_shortened(rows))
    keywords += _radians(every)
    kind = "Acknowledgement of" if command.ack else "Reply to"
    return MessageClass(
        f"{message_class(command.name)}Reply",
        (f"Reply[{returns(command)}]", *keywords),
        f"{kind} {command.name}.",
        tuple(fields),
    )


def _event(command: Command) -> MessageClass:
    reply = _reply(command)
    keywords = [part for part in reply.parts[1:] if not part.startswith(("to=", "result"))]
    return MessageClass(
        message_class(command.name),
        ("Event", f'event="{command.name}"', *keywords),
        f"{command.title}; the device sends it without a request.",
        reply.fields,
    )


def _layout(rows: list[tuple[str, ...]], names: tuple[str, ...], plain: bool) -> list[str]:
    """Return the keywords that state the variants; ``plain`` if their lengths tell them apart."""
    if not plain:
        texts = tuple(tuple(map(Name, row)) for row in rows)
        # If it does not fit on a line of its own, it has a line for each variant.
        return [f"variants={literal(texts, indent=4, before=len('variants='), after=1)}"]
    wire = tuple(_name_or_constant(part) for part in max(rows, key=len, default=()))
    return [f"wire={_row(wire)}"] if wire != tuple(map(_quoted, names)) else []


def _name_or_constant(part: str) -> str:
    return part[1:].split(",")[0] if part.startswith("(") else part


def _row_of(variant: Variant) -> tuple[str, ...]:
    """Return the parts of a variant as text: names, names with defaults, constants."""
    return tuple(map(_part, variant))


def _part(field: Field) -> str:
    if field.counts:
        return "..."
    if field.const is not None:
        return python_value(field.type, (field.const,), on_wire=True)
    if field.default is not None:
        return f"({_quoted(field.name)}, {python_value(field.type, field.default)})"
    return _quoted(field.name)


def _radians(parameters: list[Parameter]) -> list[str]:
    names = [_quoted(parameter.name) for parameter in parameters if parameter.radians]
    return [f"radians={_row(names)}"] if names else []


def _quoted(name: str) -> str:
    return f'"{name}"'


def _row(parts: Iterable[str]) -> str:
    found = list(parts)
    return f"({found[0]},)" if len(found) == 1 else f"({', '.join(found)})"


def classes_used(command: Command) -> set[str]:
    """Return the enums and named tuples that a command's messages name."""
    others = [result_type(parameter) for parameter in reply_parameters(command)]
    return classes_in_method(command) | _classes_named(command, others)


def classes_in_method(command: Command) -> set[str]:
    """Return the enums and named tuples that a command's method names."""
    arguments = [argument_type(parameter) for parameter in parameters(command)]
    found = _classes_named(command, [returns(command), *arguments])
    if command.text is not None or len(results(command)) > 1:
        found.add(returns(command))
    return found


def _classes_named(command: Command, annotations: list[str]) -> set[str]:
    words = set(re.findall(r"\w+", " ".join(annotations)))
    types = [type for field in command.fields for type in (field.type, *_case_types(field))]
    types += [type.of for type in types if isinstance(type, Listed)]
    return {type.class_name for type in types if type.class_name in words}


def _case_types(field: Field) -> tuple[Type, ...]:
    return tuple(type for _, type in field.cases)
