"""Orders that are not obeyed as they were given: ignored, stored wrong, applied elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from cobotwire.codec.interface import Codec, Message
from cobotwire.errors import ProtocolError
from cobotwire.table import Command, Field, Table
from mutation.device.broken import BrokenArm, Fault, Said
from mutation.device.cells import Cell, framed, joined, take_apart
from mutation.device.exchanges import distinct, pickers, request_fields
from mutation.mutant import Mutant

Change = Callable[[Field, Cell], int]


class Ignored(Fault):
    """One order is answered as if it had been obeyed."""

    def __init__(self, command: Command) -> None:
        self._command = command
        self._answer = b""

    def request(self, codec: Codec, asked: Message, data: bytes) -> bytes:
        """Keep the order from the arm."""
        return b"" if asked.command is self._command else data

    def reply(self, codec: Codec, asked: Message, data: bytes) -> list[Said]:
        """What would have been said: an acknowledgement, or the first form at its usual value."""
        if asked.command is not self._command or not self._command.reply:
            return [Said(0.0, data)]
        fields = [
            [Cell(number, min(max(1, number.minimum), number.maximum)) for number in numbers]
            for numbers in (field.cases[0].numbers for field in self._command.reply[0].fields)
        ]
        return [Said(0.0, framed(codec.table.frame, self._command.id, joined(fields)))]


class Misread(Fault):
    """One field of one order is understood wrong."""

    def __init__(self, command: Command, field: Field, change: Change) -> None:
        self._command = command
        self._field = field
        self._change = change

    def request(self, codec: Codec, asked: Message, data: bytes) -> bytes:
        """The order with its field changed; where that is none, the order as it is."""
        if asked.command is not self._command:
            return data
        frame = codec.table.frame
        fields = take_apart(frame, asked, data)
        for at, field in enumerate(asked.layout.fields):
            if field.name == self._field.name:
                cells = fields[at]
                fields[at] = [_fit(field, cell, self._change(field, cell)) for cell in cells]
        changed = framed(frame, asked.command.id, joined(fields))
        return changed if _is_legal(codec, asked.command, changed) else data

    def reply(self, codec: Codec, asked: Message, data: bytes) -> list[Said]:
        """The answer echoes what was sent, not what was understood."""
        return [Said(0.0, data)]


def wrong_setters(table: Table) -> Iterator[Mutant]:
    """Every command that is no query, ignored, and with each of its fields misread."""
    parts = pickers(table)
    for command in distinct(table):
        if command.safety == "query":
            continue
        yield _ignored(table, command)
        for field in request_fields(command):
            for kind, text, change in _misreadings(field, parts):
                yield _misread(table, command, field, kind, text, change)


def _ignored(table: Table, command: Command) -> Mutant:
    return Mutant(
        "ignored", command.name, "", "", lambda clock: BrokenArm(table, Ignored(command), clock)
    )


def _misread(
    table: Table, command: Command, field: Field, kind: str, text: str, change: Change
) -> Mutant:
    return Mutant(
        kind,
        command.name,
        field.name,
        text,
        lambda clock: BrokenArm(table, Misread(command, field, change), clock),
    )


def _misreadings(field: Field, parts: set[str]) -> Iterator[tuple[str, str, Change]]:
    numbers = [number for case in field.cases for number in case.numbers]
    if field.choices and len(field.choices) < 2:
        return
    if field.name in parts:
        yield "wrong part", "the next one is meant", _next
    elif field.choices:
        yield "stored wrong", "as the next legal value", _next
    else:
        yield "stored wrong", "a tenth of it", lambda _, cell: -(-cell.whole // 10)
        yield "stored wrong", "half of it", lambda _, cell: -(-cell.whole // 2)
        if any(number.minimum < 0 for number in numbers):
            yield "stored wrong", "without its sign", lambda _, cell: abs(cell.whole)


def _next(field: Field, cell: Cell) -> int:
    """The next legal value, and behind the last one the first."""
    if field.choices:
        return field.choices[(field.choices.index(cell.whole) + 1) % len(field.choices)]
    after = cell.whole + 1
    return after if after <= cell.number.maximum else cell.number.minimum


def _fit(field: Field, cell: Cell, whole: int) -> Cell:
    """The number, or the nearest one that the field allows."""
    if not field.choices:
        whole = min(max(whole, cell.number.minimum), cell.number.maximum)
    return replace(cell, whole=whole)


def _is_legal(codec: Codec, command: Command, data: bytes) -> bool:
    try:
        return codec.decode("request", data, of=command.name).command is command
    except ProtocolError:
        return False
