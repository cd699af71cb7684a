"""Describes the message classes of a command; the template writes them, editions share them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cobotwire_codegen.lower import message_class
from cobotwire_codegen.model import Command, Enum, Field, Type, Value
from cobotwire_codegen.render.layout import laid_out
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

    @property
    def head(self) -> str:
        """The head of the class, up to its colon."""
        return laid_out(f"class {self.name}(", list(self.parts), "):", 0)


def message_classes(command: Command) -> tuple[MessageClass, ...]:
    """Return the class of the request, and that of the reply if there is one."""
    if not command.replies and command.text is None:
        return (_request(command),)
    return _request(command), _reply(command)


def _request(command: Command) -> MessageClass:
    arguments = parameters(command)
    declared = [argument.name for argument in arguments]
    longest = max(command.requests, key=len)
    wire = [_part(field) for field in longest]
    keywords = [f'command="{command.name}"']
    if wire != [_quoted(name) for name in declared]:
        keywords.append(f"wire={_row(wire)}")
    keywords += _radians(arguments)
    text = [name for name, _ in command.request_text.fields] if command.request_text else []
    if text:
        keywords.append(f"text={_row(map(_quoted, text))}")
    fields = [f"{argument.name}: {argument_type(argument)}" for argument in arguments]
    # Arguments with a default come last, also after text.
    defaults = [f"{f} = None" for f, a in zip(fields, arguments) if a.optional]
    needed = [f for f, a in zip(fields, arguments) if not a.optional]
    return MessageClass(
        message_class(command.name),
        (f"Request[{returns(command)}]", *keywords),
        f"{command.title}.",
        (*needed, *(f"{name}: str" for name in text), *defaults),
    )


def _reply(command: Command) -> MessageClass:
    found = results(command)
    every = reply_parameters(command)
    others = [parameter for parameter in every if parameter not in found]
    fields = [f"{result.name}: {result_type(result)}" for result in found]
    fields += [f"{other.name}: {result_type(other)} | None = None" for other in others]
    keywords = [f"to={message_class(command.name)}"]
    if command.text is not None:
        names = [name for name, _ in command.text.fields]
        fields = [f"{name}: str" for name in names]
        keywords.append(f"result={command.text.class_name}")
        keywords.append(f"text={_row(map(_quoted, names))}")
    elif len(found) > 1:
        keywords.append(f"result={result_class(command)}")
    wire = [_part(field) for field in max(command.replies, key=len, default=())]
    if wire != [_quoted(parameter.name) for parameter in (*found, *others)]:
        keywords.append(f"wire={_row(wire)}")
    keywords += _radians(every)
    kind = "Acknowledgement of" if command.ack else "Reply to"
    return MessageClass(
        f"{message_class(command.name)}Reply",
        (f"Reply[{returns(command)}]", *keywords),
        f"{kind} {command.name}.",
        tuple(fields),
    )


def _part(field: Field) -> str:
    return _quoted(field.name) if field.const is None else str(field.const)


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
    words = {word for annotation in annotations for word in annotation.split(" | ")}
    types = [type for field in command.fields for type in (field.type, *_case_types(field))]
    return {t.class_name for t in types if isinstance(t, Enum | Value) and t.class_name in words}


def _case_types(field: Field) -> tuple[Type, ...]:
    return tuple(type for _, type in field.cases)
