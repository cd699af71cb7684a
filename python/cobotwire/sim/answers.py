"""What a behaviour left out of a reply, and what no wire can say: replies that are legal anyway."""

from __future__ import annotations

from typing import Any

from cobotwire.table import Command, Field, Number


def complete(command: Command, given: dict[str, Any], result: dict[str, Any]) -> dict[str, Any]:
    """Fill a reply up: echoes from the request, the rest with what is legal and usual."""
    if command.text is not None:
        return {name: result.get(name, "") for name in command.text.fields}
    form = command.reply[_form(command, result)]
    # An acknowledgement says 1, done.
    usual = 1 if command.ack else 0
    return {
        field.name: given[field.name] if field.echo else result.get(field.name, _near(field, usual))
        for field in form.fields
    }


def sayable(command: Command, result: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """The same reply with each number inside what the edition allows in its place."""
    said = dict(values)
    for field in command.reply[_form(command, result)].fields:
        row = values[field.name] if field.many else (values[field.name],)
        kept = tuple(_inside(number, value) for number, value in zip(field.cases[0].numbers, row))
        if not field.echo:
            said[field.name] = kept if field.many else kept[0]
    return said


def _inside(number: Number, value: Any) -> Any:
    low, high = number.minimum, number.maximum
    if number.scaled:
        share = number.multiply / number.divide
        return min(max(value, low * share), high * share)
    return min(max(value, low), high)


def _form(command: Command, result: dict[str, Any]) -> int:
    """The first form of the reply that has room for the whole result."""
    for index, form in enumerate(command.reply):
        if set(result) <= {field.name for field in form.fields}:
            return index
    return 0


def _near(field: Field, usual: int) -> Any:
    """The legal value that is nearest to the usual one."""
    numbers = field.cases[0].numbers
    values = [
        field.choices[0] if field.choices else min(max(usual, number.minimum), number.maximum)
        for number in numbers
    ]
    scaled = [
        value * number.multiply / number.divide if number.scaled else value
        for value, number in zip(values, numbers)
    ]
    return scaled if field.many else scaled[0]
