"""Table entries as Python expressions."""

from __future__ import annotations

from cobotwire_codegen import lower
from cobotwire_codegen.model import Command, Edition, Family, Field, Text, Type, Value
from cobotwire_codegen.render.literal import Call, Name


def all_commands(edition: Edition) -> tuple[Name, ...]:
    """The commands of all families, as one tuple."""
    return tuple(Name(f"*{family.name}.COMMANDS") for family in edition.families)


def addresses(edition: Edition) -> tuple[int, ...]:
    """The legal address bytes, as one tuple."""
    return tuple(member.value for member in edition.frame.addresses)


def place(command: Command) -> str:
    """Where a command stands in the spec; behind it, the changes that a delta made."""
    spots = (command.place, *(change.place for change in command.changes))
    return " ".join(f"{spot.file}:{spot.line}" for spot in spots)


def type_expression(type: Type) -> tuple[Call, ...]:
    """A type's numbers, for the table of types."""
    return tuple(
        Call("Number", *(value for value in number.values())) for number in lower.numbers(type)
    )


def command_expression(family: Family, command: Command, named: dict[Type, str]) -> Call:
    """A command, for the table of its family."""
    text = command.text
    keywords = {
        "id": Name(f"0x{command.id:02X}"),
        "name": command.name,
        "title": command.title,
        "doc": command.doc,
        "family": family.name,
        "safety": command.safety,
        "deadline_ms": command.deadline_ms,
        "request": tuple(_layout(form, named) for form in command.forms("request")),
        "reply": tuple(_layout(form, named) for form in command.forms("reply")),
        "text": text
        and Call(
            "TextReply", text.prefixes, tuple(name for name, _ in text.fields), text.silence_ms
        ),
        "notes": lower.notes(command),
        "ack": command.ack,
        "request_text": _text_request(command.request_text),
        "role": command.role,
        "read_by": command.read_by
        and Call("ReadBack", command.read_by.query, command.read_by.fields),
        "tries": command.tries,
        "agrees_with": command.agrees_with,
    }
    needed = (
        "reply",
        "text",
        "notes",
        "ack",
        "request_text",
        "role",
        "read_by",
        "tries",
        "agrees_with",
    )
    return Call("Command", **{k: v for k, v in keywords.items() if k not in needed or v})


def _text_request(text: Text | None) -> Call | None:
    if text is None:
        return None
    fields = tuple(name for name, _ in text.fields)
    return Call("TextRequest", text.prefixes, fields, text.suffix)


def _layout(form: tuple[Field, ...], named: dict[Type, str]) -> Call:
    return Call("Layout", tuple(_field(field, form, named) for field in form))


def _field(field: Field, form: tuple[Field, ...], named: dict[Type, str]) -> Call:
    cases = tuple(
        Call("Case", when, Name(f"types.{named[type]}") if type in named else type_expression(type))
        for when, type in lower.cases(field)
    )
    keywords = {
        "many": isinstance(field.type, Value),
        "choices": lower.field_choices(field),
        "labels": lower.labels(field.type) if field.const is None else (),
        "selector": lower.selector(field, form),
        "echo": bool(field.echo),
    }
    defaults = {"many": False, "choices": (), "labels": (), "selector": -1, "echo": False}
    given = {name: value for name, value in keywords.items() if value != defaults[name]}
    return Call("Field", field.name, lower.kind(field.type), cases, field.doc, **given)


def types_used(family: Family, named: dict[Type, str]) -> bool:
    """Whether a family's table refers to the table of types."""
    fields = [field for command in family.commands for field in command.fields]
    return any(type in named for field in fields for _, type in lower.cases(field))


def names_used(family: Family, named: dict[Type, str]) -> list[str]:
    """The record classes that a family's table needs."""
    fields = [field for command in family.commands for field in command.fields]
    names = {"Command", "Layout"}
    if fields:
        names |= {"Case", "Field"}
    if any(type not in named for field in fields for _, type in lower.cases(field)):
        names.add("Number")
    if any(command.text for command in family.commands):
        names.add("TextReply")
    if any(command.request_text for command in family.commands):
        names.add("TextRequest")
    if any(command.read_by for command in family.commands):
        names.add("ReadBack")
    return sorted(names)
