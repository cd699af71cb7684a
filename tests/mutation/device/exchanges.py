"""Find the commands and fields of an edition that can have a fault, each once."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

from cobotwire import codec as codecs
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command, Field, Table, Variant
from mutation.device.cells import Cell
from mutation.device.legal import draw_request

DRAWS = 8


def distinct(table: Table) -> list[Command]:
    """Return the commands that have their own requests on the line.

    Two commands may share an id and every request: one reads angles in degrees, another in radians.
    The device cannot distinguish them, so a fault in one is a fault in both.
    """
    codec = codecs.load(table)
    random = Random(1)

    def is_own(command: Command) -> bool:
        try:
            return any(
                codec.decode("request", draw_request(table, command, random)).command is command
                for _ in range(DRAWS)
            )
        except ProtocolError as error:
            raise AssertionError(f"{command.name}: an illegal request was drawn") from error

    # Nothing is sent for an event.
    return [command for command in table.commands if command.request and is_own(command)]


def reply_fields(command: Command) -> list[Field]:
    """Return the fields of all variants of a reply, each name once."""
    return _distinct_fields(command.reply)


def request_fields(command: Command) -> list[Field]:
    """Return the fields of all variants of a request, each name once."""
    return _distinct_fields(command.request)


def _distinct_fields(variants: Sequence[Variant]) -> list[Field]:
    found: dict[str, Field] = {}
    for variant in variants:
        for field in variant.fields:
            found.setdefault(field.name, field)
    return list(found.values())


def pickers(table: Table) -> set[str]:
    """Return the names of fields that choose a part: a joint, a pin, an axis, a register.

    They select the case of another field, or are arguments of a query and only echoed in replies.
    """
    arguments, reported, selectors = set(), set(), set()
    for command in table.commands:
        for variant in command.request:
            selectors |= {
                variant.fields[f.selector].name for f in variant.fields if f.selector >= 0
            }
        if command.safety == "query":
            arguments |= {f.name for f in request_fields(command) if not _has_scale(f)}
        reported |= {field.name for field in reply_fields(command) if not field.echo}
    return (arguments - reported) | selectors


def _has_scale(field: Field) -> bool:
    return any(number.scaled for case in field.cases for number in case.numbers)


def next_value(field: Field, cell: Cell) -> int:
    """Return the next legal raw value, or the first one after the last."""
    if field.choices:
        at = field.choices.index(cell.raw) if cell.raw in field.choices else -1
        return field.choices[(at + 1) % len(field.choices)]
    after = cell.raw + 1
    return after if after <= cell.number.maximum else cell.number.minimum
