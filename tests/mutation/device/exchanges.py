"""Find the commands and fields that can have a fault, each once, and draw legal requests.

The draws share no values and no code with the testers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from random import Random

from cobotwire import codec as codecs
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Case, Command, Field, Number, Table, Variant
from mutation.device.cells import Cell, framed, joined

DRAWS = 8
# The last reported values, by the unit and scale of each number of a row.
Reported = Mapping[tuple[object, ...], list[int]]


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


def draw_request(
    table: Table, command: Command, random: Random, reported: Reported | None = None
) -> bytes:
    """Return a legal request of ``command``; some have reported values, or values near them."""
    variant, addresses = random.choice(command.request), table.frame.addresses
    data = joined(draw_fields(variant, random, reported or {}))
    address = random.choice(addresses) if addresses else None
    return framed(table.frame, command.id, data, address)


def draw_fields(variant: Variant, random: Random, reported: Reported) -> list[list[Cell]]:
    """Return legal numbers for each field; selectors are drawn first."""
    drawn: dict[int, list[Cell]] = {}
    order = sorted(range(len(variant.fields)), key=lambda at: variant.fields[at].selector >= 0)
    for at in order:
        field = variant.fields[at]
        case = field.case(drawn[field.selector][0].raw if field.selector >= 0 else None)
        assert case is not None, "a legal selector picks a case"
        recalled = reported.get(shape(case)) if field.many and random.random() < 0.7 else None
        drawn[at] = (
            _recall(case, recalled, random)
            if recalled
            else [Cell(number, _draw(field, number, random)) for number in case.numbers]
        )
    return [drawn[at] for at in range(len(variant.fields))]


def shape(case: Case) -> tuple[object, ...]:
    """Return a key that is equal for rows of numbers that can replace each other."""
    return tuple((number.unit, number.multiply, number.divide) for number in case.numbers)


def _recall(case: Case, reported: list[int], random: Random) -> list[Cell]:
    """Return the reported values, or legal values near them."""
    far = random.choice((0, 0, 5, 400))
    return [
        Cell(number, number.clamp(raw + random.randint(-far, far)))
        for number, raw in zip(case.numbers, reported)
    ]


def _draw(field: Field, number: Number, random: Random) -> int:
    """Return a bound, a value near zero, or any value: each kind reveals different faults."""
    if choices := field.choices or number.choices:
        return random.choice(choices)
    low, high = number.minimum, number.maximum
    share = (high - low) // 16
    near = min(max(0, low), high)
    return random.choice(
        (
            *(low, high, near),
            random.randint(low, high),
            *(random.randint(max(low, near - share), min(high, near + share)) for _ in range(3)),
        )
    )
