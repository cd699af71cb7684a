"""Which commands of an edition a device can be wrong about, each once."""

from __future__ import annotations

from random import Random

from cobotwire import codec as codecs
from cobotwire.errors import ProtocolError
from cobotwire.table import Command, Field, Table
from mutation.device.legal import draw_request

TRIES = 8


def distinct(table: Table) -> list[Command]:
    """The commands that have requests of their own on the line.

    Two calls may share an id and every request, such as angles read in degrees or in radians. The
    device cannot tell them apart, so what is wrong with one is wrong with both.
    """
    codec = codecs.load(table)
    random = Random(1)  # noqa: S311  (a seed for repeatable draws, not a secret)

    def is_own(command: Command) -> bool:
        try:
            return any(
                codec.decode("request", draw_request(table, command, random)).command is command
                for _ in range(TRIES)
            )
        except ProtocolError as error:
            raise AssertionError(f"{command.name}: an illegal request was drawn") from error

    return [command for command in table.commands if is_own(command)]


def reply_fields(command: Command) -> list[Field]:
    """The fields of all forms of a reply, each name once."""
    found: dict[str, Field] = {}
    for layout in command.reply:
        for field in layout.fields:
            found.setdefault(field.name, field)
    return list(found.values())


def request_fields(command: Command) -> list[Field]:
    """The fields of all forms of a request, each name once."""
    found: dict[str, Field] = {}
    for layout in command.request:
        for field in layout.fields:
            found.setdefault(field.name, field)
    return list(found.values())


def pickers(table: Table) -> set[str]:
    """Names of fields that say which part is meant: a joint, a pin, an axis, a register.

    They decide how another field reads, or a query is asked by them and no reply tells them but
    as an echo.
    """
    asked, told, deciding = set(), set(), set()
    for command in table.commands:
        for layout in command.request:
            deciding |= {layout.fields[f.selector].name for f in layout.fields if f.selector >= 0}
        if command.safety == "query":
            asked |= {f.name for f in request_fields(command) if not _has_scale(f)}
        told |= {field.name for field in reply_fields(command) if not field.echo}
    return (asked - told) | deciding


def _has_scale(field: Field) -> bool:
    return any(number.scaled for case in field.cases for number in case.numbers)
