"""Queries of the same thing tell the same while the arm rests; best where nothing is zero."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cobotwire.conformance.device.catalogue import AGREES
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.mover import POSES, TICK_DEGREES, Mover
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.values import units
from cobotwire.table import Command, Table

# The servo position that is a joint's zero.
ZERO_TICK = 2048
# How far two readings of the same may lie apart, by unit: a tick, as a joint at rest trembles.
APART = {"degree": TICK_DEGREES + 0.011, "millimetre": 1.0, "tick": 2.0}

Reading = list[tuple[str, str, Any]]


def agrees(table: Table, command: Command) -> bool:
    """Whether other queries tell the same."""
    return bool(command.agrees_with)


@trial(AGREES, of=agrees)
def agreement(case: Case) -> None:
    """Compare with each of the others, joint by joint."""
    if case.bench.leave.workspace:
        mover = Mover(case)
        mover.go(mover.pose(0))
    for name in case.command.agrees_with:
        other = case.bench.table.command(name)
        rows = reading(case, other)
        if case.command.request[0].fields:
            for part, row in enumerate(rows[: case.bench.table.joints], 1):
                compare(case, other, reading(case, case.command, (part,)), [row])
        else:
            compare(case, other, reading(case, case.command), rows)


def reading(case: Case, query: Command, values: Sequence[Any] = ()) -> Reading:
    """The numbers of a query's reply, each with its name and unit.

    Raises:
        Unsupported: it is not answered.
    """
    good = case.bench.ask(query, values).good
    if good is None or good.message is None:
        raise Unsupported(f"{query.name} tells nothing")
    return [
        (f"{field.name}.{number.name}" if number.name else field.name, number.unit, value)
        for field in good.message.layout.fields
        if not field.echo
        for number, value in zip(field.cases[0].numbers, _row(good.fields[field.name]))
    ]


def compare(case: Case, other: Command, mine: Reading, theirs: Reading) -> None:
    """Each run of parts with the same units as the other's, part by part."""
    for one, two in zip(_matching(mine, theirs), theirs):
        (name, unit, value), (its, its_unit, its_value) = one, two
        if unit == "tick" and its_unit == "degree":
            value, its_value = abs(value - ZERO_TICK) * TICK_DEGREES, abs(its_value)
        reason = f"{name} is {one[2]} {unit}, but {other.name} says {its} = {two[2]} {its_unit}"
        apart = APART.get(its_unit, 0.0)
        case.expect(AGREES, abs(value - its_value) <= apart, f"{case.command.name}: {reason}")


def _matching(mine: Reading, theirs: Reading) -> Reading:
    """The part of a reading that is about the same: as long, with the same units."""
    units = [unit for _, unit, _ in theirs]
    for at in range(len(mine) - len(units) + 1):
        if [unit for _, unit, _ in mine[at : at + len(units)]] == units:
            return mine[at : at + len(units)]
    return mine if len(mine) == len(theirs) else []


def _row(value: Any) -> tuple[Any, ...]:
    return tuple(value) if isinstance(value, tuple | list) else (value,)


# How far apart what the arm calculates and what it tells may lie. The end follows joints that stand
# on ticks; near a stretched pose a tick of the end is some degrees of a joint.
CALCULATED = {"degree": 3.0, "millimetre": 2.5}


def calculates(table: Table, command: Command) -> bool:
    """Whether a query turns rows of what the arm tells of itself into such a row."""
    shown = {
        units(c.reply[0].fields[0].cases[0].numbers)
        for c in table.commands
        if c.role in ("joints", "coordinates")
    }
    rows = [*command.request[0].fields, *(command.reply[0].fields if command.reply else ())]
    rowwise = all(f.many and units(f.cases[0].numbers) in shown for f in rows)
    return command.safety == "query" and bool(command.request[0].fields) and rowwise


@trial(AGREES, of=calculates)
def calculation(case: Case) -> None:
    """Ask about where the arm is: the answer is where the arm is."""
    mover = Mover(case) if case.bench.leave.workspace else None
    for which in range(len(POSES)) if mover else (0,):
        if mover:
            mover.go(mover.pose(which))
        known = case.bench.known()
        given = [field.cases[0].numbers for field in case.command.request[0].fields]
        if any(units(numbers) not in known for numbers in given):
            raise Unsupported("nothing tells where the arm is")
        mine = reading(case, case.command, [known[units(numbers)] for numbers in given])
        told = known[tuple(unit for _, unit, _ in mine)]
        wrong = [
            f"{name} is {value} {unit}, but the arm stands at {stands}"
            for (name, unit, value), stands in zip(mine, told)
            if abs(value - stands) > CALCULATED[unit]
        ]
        case.expect(AGREES, not wrong, f"{case.command.name}: {'; '.join(wrong)}")
