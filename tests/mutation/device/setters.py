"""Devices that ignore a setter, store a wrong value, or apply it to another part."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command, Field, Table
from mutation.device.broken import BrokenArm, Fault, TimedBytes
from mutation.device.cells import Cell, framed, joined, replier, take_apart
from mutation.device.exchanges import distinct, pickers, request_fields
from mutation.mutant import Mutant

Change = Callable[[Field, Cell], int]


class Ignored(Fault):
    """One setter gets its reply, but is not carried out."""

    def __init__(self, command: Command) -> None:
        self._command = command
        self._answer = b""

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return nothing, so that the arm does not receive the request."""
        return b"" if request.command is self._command else data

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the acknowledgement, or the first variant of the reply with its usual value."""
        if request.command is not self._command or not self._command.reply:
            return [TimedBytes(0.0, data)]
        fields = [
            [Cell(number, min(max(1, number.minimum), number.maximum)) for number in numbers]
            for numbers in (field.cases[0].numbers for field in self._command.reply[0].fields)
        ]
        table = codec.table
        address = replier(table, request.address)
        reply = framed(table.frame, self._command.id, joined(fields), address)
        return [TimedBytes(0.0, reply)]


class Misread(Fault):
    """One field of one request is misread."""

    def __init__(self, command: Command, field: Field, change: Change) -> None:
        self._command = command
        self._field = field
        self._change = change

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return the request with its field changed, unless that is not legal."""
        if request.command is not self._command:
            return data
        frame = codec.table.frame
        fields = take_apart(frame, request, data)
        for at, field in enumerate(request.variant.fields):
            if field.name == self._field.name:
                cells = fields[at]
                fields[at] = [_fit(field, cell, self._change(field, cell)) for cell in cells]
        changed = framed(frame, request.command.id, joined(fields), request.address)
        return changed if _is_legal(codec, request.command, changed) else data

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the reply with the fields that were sent, not those that were misread."""
        return [TimedBytes(0.0, data)]


def wrong_setters(table: Table) -> Iterator[Mutant]:
    """Yield a mutant that ignores, and mutants that misread each field of, every setter."""
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
        yield "wrong part", "the next part instead", _next
    elif field.choices:
        yield "stored wrong", "as the next legal value", _next
    else:
        yield "stored wrong", "a tenth of it", lambda _, cell: -(-cell.raw // 10)
        yield "stored wrong", "half of it", lambda _, cell: -(-cell.raw // 2)
        if any(number.minimum < 0 for number in numbers):
            yield "stored wrong", "without its sign", lambda _, cell: abs(cell.raw)


def _next(field: Field, cell: Cell) -> int:
    """Return the next legal value, or the first one after the last."""
    if field.choices:
        return field.choices[(field.choices.index(cell.raw) + 1) % len(field.choices)]
    after = cell.raw + 1
    return after if after <= cell.number.maximum else cell.number.minimum


def _fit(field: Field, cell: Cell, raw: int) -> Cell:
    """Return the nearest raw value that the field allows."""
    if not field.choices:
        raw = min(max(raw, cell.number.minimum), cell.number.maximum)
    return replace(cell, raw=raw)


def _is_legal(codec: Codec, command: Command, data: bytes) -> bool:
    try:
        return codec.decode("request", data, of=command.name).command is command
    except ProtocolError:
        return False
