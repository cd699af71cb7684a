"""Replies with one field wrong: its sign rule, scale, width, order, endianness, range or value."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from cobotwire.codec.interface import Codec, Message
from cobotwire.table import Command, Field, Number, Table
from mutation.device.broken import BrokenArm, Fault, Said
from mutation.device.cells import Cell, framed, joined, take_apart
from mutation.device.exchanges import distinct, reply_fields
from mutation.mutant import Mutant

Cells = list[Cell]
Alter = Callable[[Cells], Cells]


@dataclass(frozen=True, slots=True)
class Alteration:
    """A way to send a field wrong; ``fits`` says whether the field can be sent so at all."""

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

    def reply(self, codec: Codec, asked: Message, data: bytes) -> list[Said]:
        """The answer with its field altered, in a frame that is right for what it holds."""
        if asked.command is not self._command or not data:
            return [Said(0.0, data)]
        frame = codec.table.frame
        said = codec.decode("reply", data, of=asked.command.name)
        fields = take_apart(frame, said, data)
        for at, field in enumerate(said.layout.fields):
            if field.name == self._field.name:
                fields[at] = self._alteration.alter(self._field, fields[at])
        return [Said(0.0, framed(frame, asked.command.id, joined(fields)))]


def wrong_fields(table: Table) -> Iterator[Mutant]:
    """Every field of every reply that is due, in every way in which it can be wrong."""
    for command in distinct(table):
        for field in reply_fields(command) if command.answers else ():
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


def _whole(change: Callable[[Number, int], int]) -> Callable[[Field, Cells], Cells]:
    """Each number of the field changed by itself."""
    return lambda _, cells: [replace(c, whole=change(c.number, c.whole)) for c in cells]


def _written(change: Callable[[Number], Number]) -> Callable[[Field, Cells], Cells]:
    """Each number of the field written otherwise."""
    return lambda _, cells: [replace(cell, number=change(cell.number)) for cell in cells]


def _is_number(field: Field, number: Number) -> bool:
    return not field.choices


def _signed(field: Field, number: Number) -> bool:
    return number.signed_at < (1 << 8 * number.width) - 1


def _magnitude(number: Number, whole: int) -> int:
    """The top bit is the sign, the others the magnitude."""
    return 256**number.width // 2 + abs(whole) if whole < 0 else whole


def _room_above(field: Field, number: Number) -> bool:
    return max(field.choices or (number.maximum,)) < number.signed_at


def _room_below(field: Field, number: Number) -> bool:
    lowest = number.signed_at + 1 - 256**number.width if _signed(field, number) else 0
    return min(field.choices or (number.minimum,)) > lowest


def _next_choice(field: Field, cells: Cells) -> Cells:
    """Each number is the next of those that are legal, and the last one the first."""
    return [replace(cell, whole=_next(field, cell)) for cell in cells]


def _next(field: Field, cell: Cell) -> int:
    if field.choices:
        at = field.choices.index(cell.whole) if cell.whole in field.choices else -1
        return field.choices[(at + 1) % len(field.choices)]
    at = cell.whole + 1
    return at if at <= cell.number.maximum else cell.number.minimum


def _first(field: Field, cells: Cells) -> Cells:
    return [replace(c, whole=min(field.choices or (c.number.minimum,))) for c in cells]


ALTERATIONS = (
    Alteration(
        "sign",
        "without its sign",
        lambda f, n: _is_number(f, n) and _signed(f, n),
        _whole(lambda _, whole: abs(whole)),
    ),
    Alteration(
        "sign",
        "as sign and magnitude",
        lambda f, n: _is_number(f, n) and _signed(f, n),
        _whole(_magnitude),
    ),
    Alteration("sign", "with the other sign", _is_number, _whole(lambda _, whole: -whole)),
    Alteration("scale", "ten times as large", _is_number, _whole(lambda _, whole: whole * 10)),
    Alteration("scale", "a tenth as large", _is_number, _whole(lambda _, whole: whole // 10)),
    Alteration(
        "width",
        "in one byte each",
        lambda _, n: n.width > 1,
        _written(lambda number: replace(number, width=1)),
    ),
    Alteration(
        "width",
        "with a byte more each",
        lambda *_: True,
        _written(lambda number: replace(number, width=number.width + 1)),
    ),
    Alteration(
        "order",
        "last element first",
        lambda field, _: field.many,
        lambda _, cells: cells[::-1],
    ),
    Alteration(
        "order",
        "its first two elements changed over",
        lambda field, _: field.many,
        lambda _, cells: [cells[1], cells[0], *cells[2:]],
    ),
    Alteration(
        "endianness",
        "low byte first",
        lambda _, n: n.width > 1,
        _written(lambda n: replace(n, order="little" if n.order == "big" else "big")),
    ),
    Alteration(
        "range",
        "one above the largest legal number",
        _room_above,
        lambda f, cells: [
            replace(c, whole=max(f.choices or (c.number.maximum,)) + 1) for c in cells
        ],
    ),
    Alteration(
        "range",
        "one below the smallest legal number",
        _room_below,
        lambda f, cells: [
            replace(c, whole=min(f.choices or (c.number.minimum,)) - 1) for c in cells
        ],
    ),
    Alteration("value", "the next legal one", lambda f, _: bool(f.choices), _next_choice),
    Alteration("value", "always the first legal one", lambda f, _: bool(f.choices), _first),
    Alteration("value", "always zero", _is_number, _whole(lambda *_: 0)),
)
ECHOES = (
    Alteration("echo", "the next legal value", lambda *_: True, _next_choice),
    Alteration("echo", "always the first legal value", lambda *_: True, _first),
    Alteration("width", "with a byte more", lambda *_: True, ALTERATIONS[6].alter),
)
