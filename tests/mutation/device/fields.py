"""Replies with a wrong field: its sign rule, scale, width, order, endianness, range or value."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.table import Command, Field, Number, Table
from mutation.device.broken import BrokenArm, Fault, TimedBytes
from mutation.device.cells import Cell, framed, joined, take_apart
from mutation.device.exchanges import distinct, reply_fields
from mutation.mutant import Mutant

Cells = list[Cell]
Alter = Callable[[Cells], Cells]


@dataclass(frozen=True, slots=True)
class Alteration:
    """A way to send a wrong field; ``fits`` decides whether it applies to a field."""

    kind: str
    text: str
    fits: Callable[[Field, Number], bool]
    alter: Callable[[Field, Cells], Cells]


class WrongField(Fault):
    """One field of one command's reply is altered."""

    def __init__(self, command: Command, field: Field, alteration: Alteration) -> None:
        self._command = command
        self._field = field
        self._alteration = alteration

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the reply with its field altered, in a correct frame."""
        if request.command is not self._command or not data:
            return [TimedBytes(0.0, data)]
        frame = codec.table.frame
        decoded = codec.decode("reply", data, of=request.command.name)
        fields = take_apart(frame, decoded, data)
        for at, field in enumerate(decoded.variant.fields):
            if field.name == self._field.name:
                fields[at] = self._alteration.alter(self._field, fields[at])
        wrong = framed(frame, request.command.id, joined(fields), decoded.address)
        return [TimedBytes(0.0, wrong)]


def wrong_fields(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each field of each required reply and each way to send it wrong."""
    for command in distinct(table):
        for field in reply_fields(command) if command.requires_reply else ():
            number = field.cases[0].numbers[0]
            for alteration in ECHOES if field.echo else ALTERATIONS:
                if alteration.fits(field, number):
                    yield _mutant(table, command, field, alteration)


def _mutant(table: Table, command: Command, field: Field, alteration: Alteration) -> Mutant:
    return Mutant(
        alteration.kind,
        command.name,
        field.name,
        alteration.text,
        lambda clock: BrokenArm(table, WrongField(command, field, alteration), clock),
    )


def _change_raw(change: Callable[[Number, int], int]) -> Callable[[Field, Cells], Cells]:
    """Change the raw value of each number of the field."""
    return lambda _, cells: [replace(c, raw=change(c.number, c.raw)) for c in cells]


def _written(change: Callable[[Number], Number]) -> Callable[[Field, Cells], Cells]:
    """Change how each number of the field is encoded."""
    return lambda _, cells: [replace(cell, number=change(cell.number)) for cell in cells]


def _is_number(field: Field, number: Number) -> bool:
    return not field.choices


def _signed(field: Field, number: Number) -> bool:
    return number.signed_at < (1 << 8 * number.width) - 1


def _magnitude(number: Number, raw: int) -> int:
    """Return sign and magnitude: the top bit is the sign."""
    return 256**number.width // 2 + abs(raw) if raw < 0 else raw


def _room_above(field: Field, number: Number) -> bool:
    return max(field.choices or (number.maximum,)) < number.signed_at


def _room_below(field: Field, number: Number) -> bool:
    lowest = number.signed_at + 1 - 256**number.width if _signed(field, number) else 0
    return min(field.choices or (number.minimum,)) > lowest


def _next_choice(field: Field, cells: Cells) -> Cells:
    """Replace each number by the next legal one, the last by the first."""
    return [replace(cell, raw=_next(field, cell)) for cell in cells]


def _next(field: Field, cell: Cell) -> int:
    if field.choices:
        at = field.choices.index(cell.raw) if cell.raw in field.choices else -1
        return field.choices[(at + 1) % len(field.choices)]
    at = cell.raw + 1
    return at if at <= cell.number.maximum else cell.number.minimum


def _first(field: Field, cells: Cells) -> Cells:
    return [replace(c, raw=min(field.choices or (c.number.minimum,))) for c in cells]


ALTERATIONS = (
    Alteration(
        "sign",
        "without its sign",
        lambda f, n: _is_number(f, n) and _signed(f, n),
        _change_raw(lambda _, raw: abs(raw)),
    ),
    Alteration(
        "sign",
        "as sign and magnitude",
        lambda f, n: _is_number(f, n) and _signed(f, n),
        _change_raw(_magnitude),
    ),
    Alteration("sign", "with the other sign", _is_number, _change_raw(lambda _, raw: -raw)),
    Alteration("scale", "ten times as large", _is_number, _change_raw(lambda _, raw: raw * 10)),
    Alteration("scale", "a tenth as large", _is_number, _change_raw(lambda _, raw: raw // 10)),
    Alteration(
        "width",
        "in one byte each",
        lambda _, n: n.width > 1,
        _written(lambda number: number._replace(width=1)),
    ),
    Alteration(
        "width",
        "with a byte more each",
        lambda *_: True,
        _written(lambda number: number._replace(width=number.width + 1)),
    ),
    Alteration(
        "order",
        "last element first",
        lambda field, _: field.many,
        lambda _, cells: cells[::-1],
    ),
    Alteration(
        "order",
        "its first two elements swapped",
        lambda field, _: field.many,
        lambda _, cells: [cells[1], cells[0], *cells[2:]],
    ),
    Alteration(
        "endianness",
        "low byte first",
        lambda _, n: n.width > 1,
        _written(lambda n: n._replace(order="little" if n.order == "big" else "big")),
    ),
    Alteration(
        "range",
        "one above the largest legal number",
        _room_above,
        lambda f, cells: [replace(c, raw=max(f.choices or (c.number.maximum,)) + 1) for c in cells],
    ),
    Alteration(
        "range",
        "one below the smallest legal number",
        _room_below,
        lambda f, cells: [replace(c, raw=min(f.choices or (c.number.minimum,)) - 1) for c in cells],
    ),
    Alteration("value", "the next legal value", lambda f, _: bool(f.choices), _next_choice),
    Alteration("value", "always the first legal value", lambda f, _: bool(f.choices), _first),
    Alteration("value", "always zero", _is_number, _change_raw(lambda *_: 0)),
)
ECHOES = (
    Alteration("echo", "the next legal value", lambda *_: True, _next_choice),
    Alteration("echo", "always the first legal value", lambda *_: True, _first),
    Alteration("width", "with a byte more", lambda *_: True, ALTERATIONS[6].alter),
)
