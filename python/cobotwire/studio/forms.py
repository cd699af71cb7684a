"""The commands of an edition as forms: arguments with units, ranges, choices and defaults."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from cobotwire.protocol.fields import named_fields
from cobotwire.protocol.roles import starts_motion
from cobotwire.protocol.table import Command, Field, Number, Table

Form = dict[str, Any]


def forms(table: Table) -> list[Form]:
    """Return a form for each command that can be sent, as JSON values."""
    return [_form(table, command) for command in table.commands if not command.event]


def _form(table: Table, command: Command) -> Form:
    fields = named_fields(command.request)
    texts = command.request_text.fields if command.request_text else ()
    # An argument that some variant leaves out may stay empty.
    optional = {
        name
        for name, found in fields.items()
        if len(found) < len(command.request) or any(f.default is not None for f in found)
    }
    radians = command.request_type.fields_in_radians()
    arguments = [
        {"name": name, "kind": "text", "doc": "", "optional": False}
        if name in texts
        else _argument(command, fields[name][0], name in optional, name in radians)
        for name in command.argument_names
    ]
    return {
        "name": command.name,
        "title": command.title,
        "doc": command.doc,
        "family": command.family,
        "safety": command.safety,
        "role": command.role,
        "moves": starts_motion(table, command),
        "notes": list(command.notes),
        "arguments": arguments,
    }


def _argument(command: Command, field: Field, optional: bool, radians: bool) -> Form:
    numbers = [] if field.kind in ("bytes", "text") else field.cases[0].numbers
    form: Form = {
        "name": field.name,
        "kind": field.kind,
        "doc": field.doc,
        "many": field.many,
        "optional": optional,
        "elements": [_in_radians(each) for each in elements(numbers)]
        if radians
        else elements(numbers),
        "choices": _choices(field),
    }
    if field.each or field.sizes:
        # A list of varying length is written in one box.
        form |= {"elements": [], "list": True, "rows": bool(field.each)}
    if field.kind in ("bytes", "text"):
        form["size"] = field.size
    if field.selector >= 0:
        variant = next(each for each in command.request if field in each.fields)
        form["selector"] = variant.fields[field.selector].name
        form["cases"] = [
            {"when": list(case.when), "elements": elements(case.numbers)} for case in field.cases
        ]
    return form


def elements(numbers: Sequence[Number]) -> list[Form]:
    """Return the name, the unit and the range of each number, in the units of callers."""
    return [
        {
            "name": number.name,
            "unit": number.units,
            "low": number.physical(number.minimum),
            "high": number.physical(number.maximum),
            "step": number.multiply / number.divide if number.scaled else 1,
        }
        if number.encoding == "integer"
        else {"name": number.name, "unit": number.units, "low": None, "high": None, "step": "any"}
        for number in numbers
    ]


def _in_radians(element: Form) -> Form:
    """Return the element of a number that callers pass in radians, and the wire has in degrees."""
    # Rounded towards zero, so that the ends are allowed.
    low, high = (math.trunc(math.radians(element[end]) * 1e4) / 1e4 for end in ("low", "high"))
    return element | {"unit": "radians", "low": low, "high": high, "step": "any"}


def _choices(field: Field) -> list[Form]:
    if field.kind == "flag":
        return [{"value": "on", "label": "on"}, {"value": "off", "label": "off"}]
    if field.labels:
        return [
            {"value": str(value), "label": f"{label} ({value})"}
            for value, label in zip(field.choices, field.labels)
        ]
    return [{"value": str(value), "label": str(value)} for value in field.choices]
