"""Explain why a mutant cannot be distinguished, on the line, from the correct device."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.protocol.table import Command, Field, Table
from mutation.device.broken import Mutant
from mutation.device.exchanges import reply_fields, request_fields
from mutation.device.testing import is_tested, lacking
from mutation.oracle.conversation import Conversation, conversations, only_legal, replies_of
from mutation.oracle.undefined import (
    ERRORS,
    LEFT_OPEN,
    NO_ERROR,
    OF_MEANING,
    UNWIRED,
    WIRED,
)


def reason(table: Table, mutant: Mutant) -> str:
    """Return why a mutant cannot be distinguished from the correct device; empty if it can."""
    undefined = _undefined(table, mutant)
    if undefined:
        return undefined
    field = _field(table, mutant)
    lacks = bool(lacking(table, mutant.command))
    known = field is None or field.echo or _reported(table, mutant.command, field)
    known = known and not lacks
    had, differs = [], False
    for conversation in conversations(table, mutant.command):
        replied = replies_of(table, mutant, conversation)
        had.append(conversation)
        if replied != conversation.received:
            differs = True
            if known or not only_legal(table, replied):
                return ""
    if not differs:
        return _alike(table, mutant, had)
    if lacks:
        return (
            "every wrong reply is legal, and the true one is unknown: the correct arm has none, "
            "because its geometry is not known"
        )
    assert field is not None
    return (
        f"the true value is unknown on the line: every wrong value is legal, no command sets "
        f"`{field.name}`, and no other reply repeats it"
    )


def _alike(table: Table, mutant: Mutant, had: Sequence[Conversation]) -> str:
    """Return how the mutant was compared, and what the simulated arm lacks."""
    requests = sum(len(conversation.steps) for conversation in had)
    same = f"no byte differs in {len(had)} conversations with {requests} writes in all"
    why, _, _ = lacking(table, mutant.command).partition(":")
    return f"{same}, because {why}" if why else same


# The unit of a speed, of which the edition does not define 100 percent.
SHARE = "percent"
# A label of a direction, of which the edition does not define the sign.
TURNS = "CLOCKWISE"


def _undefined(table: Table, mutant: Mutant) -> str:
    """Return what the edition does not define about a field, so that any effect is correct."""
    if mutant.command and not is_tested(table, mutant.command):
        unsafe = _unsafe(table.command(mutant.command))
        if unsafe:
            return unsafe
    if mutant.kind in OF_MEANING and mutant.command in LEFT_OPEN:
        return LEFT_OPEN[mutant.command]
    if mutant.kind in (*OF_MEANING, "stale reply") and _is_unwired(table, mutant.command):
        return UNWIRED
    if mutant.kind == "stale reply" and mutant.command in ERRORS:
        return NO_ERROR
    if not mutant.command or mutant.field in ("", *_replied(table, mutant.command)):
        return ""
    fields = {field.name: field for field in request_fields(table.command(mutant.command))}
    field = fields[mutant.field]
    if field.cases[0].numbers[0].unit == SHARE and field.name == "speed":
        return (
            "the edition defines a speed as a share of the fastest, and does not define the fastest"
        )
    if TURNS in field.labels:
        return "the edition does not define whether the angle grows when a joint turns clockwise"
    return ""


def _is_unwired(table: Table, name: str) -> bool:
    """Return whether a command is about pins, and no source says that outputs set inputs."""
    query = WIRED.get(name, name)
    backs = (command.read_by for command in table.commands)
    return query in WIRED.values() and not any(back and back.query == query for back in backs)


def _unsafe(command: Command) -> str:
    """Return why a tester does not send a motion to an arm of unknown geometry; empty if it may."""
    if command.safety != "motion":
        return ""
    if any("millimetre" in _units(field) for field in request_fields(command)):
        return (
            "the only coordinates that are safe to send are those that the arm has reported, and "
            "an arm of unknown geometry reports none"
        )
    return ""


def _replied(table: Table, name: str) -> list[str]:
    command = table.command(name)
    return [field.name for field in reply_fields(command)] if command.requires_reply else []


def _field(table: Table, mutant: Mutant) -> Field | None:
    """Return the wrong field of the reply; None if something else is wrong."""
    if not mutant.command:
        return None
    command = table.command(mutant.command)
    if not command.requires_reply:
        return None
    return next((f for f in reply_fields(command) if f.name == mutant.field), None)


def _reported(table: Table, name: str, field: Field) -> bool:
    """Return whether another command sets or reports the value of the field."""
    command = table.command(name)
    setters = [c for c in table.commands if c.read_by is not None and c.read_by.query == name]
    # A command with a constant effect shows only one value, so it does not count.
    if any(
        all(isinstance(value, str) for _, value in c.read_by.fields) for c in setters if c.read_by
    ):
        return True
    if setters and field.choices:
        return True
    return any(
        _units(field) and _units(other) == _units(field)
        for query in table.commands
        if query.requires_reply and query.id != command.id
        for other in reply_fields(query)
    )


def _units(field: Field) -> set[str]:
    return {number.unit for case in field.cases for number in case.numbers} - {""}
