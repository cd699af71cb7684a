"""Replies with a wrong field: its sign rule, scale, width, order, endianness, range or value."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import DecodedMessage
from cobotwire.protocol.table import Field, Number, Table
from mutation.device.broken import Mutant, mutant_of
from mutation.device.cells import Cell, framed, joined, take_apart
from mutation.device.exchanges import distinct, next_value, reply_fields

Cells = list[Cell]
Fits = Callable[[Field, Number], bool]


class Alteration(NamedTuple):
    """A way to send a wrong field; ``fits`` decides whether it applies to a field."""

    kind: str
    text: str
    fits: Fits
    alter: Callable[[Field, Cells], Cells]

    def in_reply(self, wanted: Field, table: Table, request: DecodedMessage, data: bytes) -> bytes:
        """Return a reply with a field altered, in a correct frame.

        Other text, such as the reason why the simulated arm cannot reply, is returned unchanged.
        """
        if not data.startswith(table.frame.header):
            return data
        decoded = codecs.load(table).decode("reply", data, of=request.command.name)
        fields = take_apart(table.frame, decoded, data)
        for at, field in enumerate(decoded.variant.fields):
            if field.name == wanted.name:
                fields[at] = self.alter(wanted, fields[at])
        return framed(table.frame, request.command.id, joined(fields), decoded.address)


def wrong_fields(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each field of each required reply and each way to send it wrong."""
    for command in distinct(table):
        for field in reply_fields(command) if command.requires_reply else ():
            for wrong in ECHOES if field.echo else ALTERATIONS:
                if wrong.fits(field, field.cases[0].numbers[0]):
                    change = partial(wrong.in_reply, field)
                    yield mutant_of(wrong.kind, wrong.text, command, change, field.name)


def _raw(change: Callable[[Number, int], int]) -> Callable[[Field, Cells], Cells]:
    """Change the raw value of each number of the field."""
    return lambda _, cells: [replace(c, raw=change(c.number, c.raw)) for c in cells]


def _encoded(change: Callable[[Number], Number]) -> Callable[[Field, Cells], Cells]:
    """Change how each number of the field is encoded."""
    return lambda _, cells: [replace(cell, number=change(cell.number)) for cell in cells]


def _each(change: Callable[[Field, Cell], int]) -> Callable[[Field, Cells], Cells]:
    """Replace each raw value of the field by another one."""
    return lambda field, cells: [replace(cell, raw=change(field, cell)) for cell in cells]


def _always(field: Field, number: Number) -> bool:
    return True


def _is_number(field: Field, number: Number) -> bool:
    return not field.choices


def _is_listed(field: Field, number: Number) -> bool:
    return bool(field.choices)


def _is_row(field: Field, number: Number) -> bool:
    return field.many


def _is_wide(field: Field, number: Number) -> bool:
    return number.width > 1


def _may_be_negative(field: Field, number: Number) -> bool:
    return _is_number(field, number) and _signed(number)


def _signed(number: Number) -> bool:
    return number.signed_at < (1 << 8 * number.width) - 1


def _has_room_above(field: Field, number: Number) -> bool:
    return max(field.choices or (number.maximum,)) < number.signed_at


def _has_room_below(field: Field, number: Number) -> bool:
    lowest = number.signed_at + 1 - 256**number.width if _signed(number) else 0
    return min(field.choices or (number.minimum,)) > lowest


def _magnitude(number: Number, raw: int) -> int:
    """Return sign and magnitude: the top bit is the sign."""
    return 256**number.width // 2 + abs(raw) if raw < 0 else raw


def _lowest(field: Field, cell: Cell) -> int:
    return min(field.choices or (cell.number.minimum,))


def _highest(field: Field, cell: Cell) -> int:
    return max(field.choices or (cell.number.maximum,))


_wider = _encoded(lambda number: number._replace(width=number.width + 1))
_low_first = _encoded(lambda n: n._replace(order="little" if n.order == "big" else "big"))
ALTERATIONS = tuple(
    Alteration(*row)
    for row in (
        ("sign", "without its sign", _may_be_negative, _raw(lambda _, raw: abs(raw))),
        ("sign", "as sign and magnitude", _may_be_negative, _raw(_magnitude)),
        ("sign", "with the other sign", _is_number, _raw(lambda _, raw: -raw)),
        ("scale", "ten times as large", _is_number, _raw(lambda _, raw: raw * 10)),
        ("scale", "a tenth as large", _is_number, _raw(lambda _, raw: raw // 10)),
        ("width", "in one byte each", _is_wide, _encoded(lambda n: n._replace(width=1))),
        ("width", "with a byte more each", _always, _wider),
        ("order", "last element first", _is_row, lambda _, cells: cells[::-1]),
        (
            "order",
            "its first two elements swapped",
            _is_row,
            lambda _, cells: [cells[1], cells[0], *cells[2:]],
        ),
        ("endianness", "low byte first", _is_wide, _low_first),
        (
            "range",
            "one above the largest legal number",
            _has_room_above,
            _each(lambda field, cell: _highest(field, cell) + 1),
        ),
        (
            "range",
            "one below the smallest legal number",
            _has_room_below,
            _each(lambda field, cell: _lowest(field, cell) - 1),
        ),
        ("value", "the next legal value", _is_listed, _each(next_value)),
        ("value", "always the first legal value", _is_listed, _each(_lowest)),
        ("value", "always zero", _is_number, _raw(lambda *_: 0)),
    )
)
ECHOES = (
    Alteration("echo", "the next legal value", _always, _each(next_value)),
    Alteration("echo", "always the first legal value", _always, _each(_lowest)),
    Alteration("width", "with a byte more", _always, _wider),
)
