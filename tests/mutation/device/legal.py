"""Draw legal requests of an edition with a seed; share no values and no code with the testers."""

from __future__ import annotations

from collections.abc import Mapping
from random import Random

from cobotwire.protocol.table import Case, Command, Field, Number, Table, Variant
from mutation.device.cells import Cell, framed, joined

# The last reported values, by the unit and scale of each number of a row.
Reported = Mapping[tuple[object, ...], list[int]]


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
