"""Complete a behaviour's reply, and move its values into the range that the wire can express."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.protocol.errors import SIMULATED
from cobotwire.protocol.table import Command, Field, Number, Variant

PREFIX = SIMULATED.encode()


class Unanswerable(Exception):
    """The arm does not know what a reply reports, or where to move, and sends no reply.

    Its text is the reason; without one, the edition does not state the geometry.
    """


def refusal(why: str) -> bytes:
    """Return the line that is sent in place of a reply: clients quote it in their errors.

    Clients skip it, as they skip text that firmware prints. The details of ``why``, after a colon,
    are left out; the arm's notes have them.
    """
    return f"{SIMULATED}{why.partition(':')[0]}\r\n".encode("ascii", "replace")


def completed(
    command: Command,
    request: Mapping[str, Any],
    result: Mapping[str, Any],
    usual: int | None = None,
) -> dict[str, Any]:
    """Return all fields of a reply: the result, echoes of the request, and usual values.

    Args:
        command: the command.
        request: the fields of the request.
        result: the fields of the reply that the behaviour states.
        usual: the value of all other fields; None: 1 for acknowledgements and for flags
            of commands that are not queries, else 0.
    """
    if command.text is not None:
        return {name: result.get(name, "") for name in command.text.fields}
    # An acknowledgement reports success as 1.
    usual = (1 if command.ack else 0) if usual is None else usual
    if command.accepted:
        usual = command.accepted[0]
    return {
        field.name: ...
        if field.counts
        else request[field.name]
        if field.echo
        else result[field.name]
        if field.name in result
        else _legal(field, 1 if field.kind == "flag" and command.safety != "query" else usual)
        for field in _variant(command, result).fields
    }


def clamped(
    command: Command, result: Mapping[str, Any], fields: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the fields of a reply; each number becomes the nearest one that the edition allows."""
    kept = dict(fields)
    for field in _variant(command, result).fields:
        if field.counts or field.each or field.kind in ("bytes", "text"):
            continue
        row = fields[field.name] if field.many else (fields[field.name],)
        values = tuple(_inside(number, value) for number, value in zip(field.cases[0].numbers, row))
        if not field.echo:
            kept[field.name] = values if field.many else values[0]
    return kept


def _inside(number: Number, value: Any) -> Any:
    inside = min(max(value, number.physical(number.minimum)), number.physical(number.maximum))
    return inside if number.real else round(inside)


def _variant(command: Command, result: Mapping[str, Any]) -> Variant:
    """Return the first variant of the reply that has all fields of the result."""
    for variant in command.reply:
        if set(result) <= {field.name for field in variant.fields}:
            return variant
    return command.reply[0]


def _legal(field: Field, usual: int) -> Any:
    """Return the usual value if it is legal.

    Otherwise the nearest legal value, or the first of a closed list.
    """
    values = []
    for number in field.cases[0].numbers:
        choices = field.choices or number.choices
        listed = usual if usual in choices else next(iter(choices), None)
        values.append(number.physical(number.clamp(usual) if listed is None else listed))
    return field.present(values)
