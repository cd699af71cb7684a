"""Legal requests of an edition, drawn with a seed; no tester's values, and no tester's code."""

from __future__ import annotations

from collections.abc import Mapping
from random import Random

from cobotwire.table import Case, Command, Field, Layout, Number, Table
from mutation.device.cells import Cell, framed, joined

# By unit and scale of each number of a row: what a reply told last.
Told = Mapping[tuple[object, ...], list[int]]


def draw_request(table: Table, command: Command, random: Random, told: Told | None = None) -> bytes:
    """A whole legal request of ``command``; perhaps about what was ``told``, or near it."""
    layout = random.choice(command.request)
    return framed(table.frame, command.id, joined(draw_fields(layout, random, told or {})))


def draw_fields(layout: Layout, random: Random, told: Told) -> list[list[Cell]]:
    """Legal numbers for each field; those that decide how others read are drawn first."""
    drawn: dict[int, list[Cell]] = {}
    order = sorted(range(len(layout.fields)), key=lambda at: layout.fields[at].selector >= 0)
    for at in order:
        field = layout.fields[at]
        case = field.cases[0]
        if field.selector >= 0:
            picked = drawn[field.selector][0].whole
            case = next(case for case in field.cases if not case.when or picked in case.when)
        recalled = told.get(shape(case)) if field.many and random.random() < 0.7 else None
        drawn[at] = (
            _recall(case, recalled, random)
            if recalled
            else [Cell(number, _draw(field, number, random)) for number in case.numbers]
        )
    return [drawn[at] for at in range(len(layout.fields))]


def shape(case: Case) -> tuple[object, ...]:
    """What two rows of numbers have in common if one can be given for the other."""
    return tuple((number.unit, number.multiply, number.divide) for number in case.numbers)


def _recall(case: Case, told: list[int], random: Random) -> list[Cell]:
    """What was told, or not far from it, as far as it is legal."""
    far = random.choice((0, 0, 5, 400))
    return [
        Cell(number, min(max(whole + random.randint(-far, far), number.minimum), number.maximum))
        for number, whole in zip(case.numbers, told)
    ]


def _draw(field: Field, number: Number, random: Random) -> int:
    """Ends, the middle, small numbers and any: faults show at different ones."""
    if field.choices:
        return random.choice(field.choices)
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
