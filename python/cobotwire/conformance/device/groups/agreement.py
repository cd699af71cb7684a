"""Compare queries of the same quantity while the arm rests, if possible away from zero."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.mover import POSES, Mover, angle_tolerance
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import as_row, request_of, units
from cobotwire.conformance.places import places
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Table

AGREES = TestCase("agrees", "While the arm rests, queries of the same quantity agree.")

# The tolerance between two readings of a quantity, by unit: a joint at rest jitters by a tick.
APART = {"millimetre": 1.0, "tick": 2.0}

Reading = list[tuple[str, str, Any]]


def _has_equals(table: Table, command: Command) -> bool:
    """Return whether other queries report the same quantity."""
    return bool(command.agrees_with)


def _agree(probe: Probe) -> None:
    """Compare with each of the other queries, joint by joint."""
    if probe.device.permissions.workspace:
        mover = Mover(probe)
        mover.go(mover.pose(0))
    for name in probe.command.agrees_with:
        other = probe.device.table.command(name)
        rows = _reading(probe, other)
        if probe.command.request[0].fields:
            for part, row in enumerate(rows[: probe.device.table.joints], 1):
                _compare(probe, other, _reading(probe, probe.command, part), [row])
        else:
            _compare(probe, other, _reading(probe, probe.command), rows)


def _reading(probe: Probe, query: Command, *values: Any) -> Reading:
    """Return the numbers of a query's reply, each with its name and unit.

    Raises:
        NotSupported: no valid reply comes.
    """
    valid = probe.device.request(request_of(query, *values)).valid
    if valid is None or valid.decoded is None:
        raise NotSupported(f"{query.name} reports nothing")
    fields = valid.decoded.fields
    return [
        (place.name, place.number.unit, as_row(fields[place.field.name])[place.element])
        for place in places(valid.decoded.variant)
        if not place.field.echo
    ]


def _compare(probe: Probe, other: Command, mine: Reading, theirs: Reading) -> None:
    """Compare the parts that have the same units as the other's, part by part."""
    table = probe.device.table
    encoders, tolerances = table.robot.encoders, {**APART, "degree": angle_tolerance(table) + 0.001}
    for one, two in zip(_matching(mine, theirs), theirs):
        (name, unit, value), (its, its_unit, its_value) = one, two
        if unit == "tick" and its_unit == "degree":
            if encoders is None:
                continue  # nothing says what a tick is
            # The direction of an encoder may be unknown.
            value, its_value = abs(value - encoders.zero) * encoders.degrees, abs(its_value)
        reason = f"{name} is {one[2]} {unit}, but {other.name} reports {its} = {two[2]} {its_unit}"
        apart = tolerances.get(its_unit, 0.0)
        probe.expect(AGREES, abs(value - its_value) <= apart, f"{probe.command.name}: {reason}")


def _matching(mine: Reading, theirs: Reading) -> Reading:
    """Return the part of a reading that is as long as the other, with the same units."""
    units = [unit for _, unit, _ in theirs]
    for at in range(len(mine) - len(units) + 1):
        if [unit for _, unit, _ in mine[at : at + len(units)]] == units:
            return mine[at : at + len(units)]
    return mine if len(mine) == len(theirs) else []


# The tolerance between calculated and reported rows, by unit. Joints rest on ticks; near a
# stretched pose, a small motion of the end takes several degrees of a joint.
CALCULATED = {"degree": 3.0, "millimetre": 2.5}


def _calculates(table: Table, command: Command) -> bool:
    """Return whether the arm also reports every row that a query takes and returns."""
    shown = {
        units(c.reply[0].fields[0].cases[0].numbers)
        for c in table.commands
        if c.role in ("joints", "coordinates")
    }
    rows = [*command.request[0].fields, *(command.reply[0].fields if command.reply else ())]
    rowwise = all(f.many and units(f.cases[0].numbers) in shown for f in rows)
    return command.safety == "query" and bool(command.request[0].fields) and rowwise


def _calculate(probe: Probe) -> None:
    """Calculate with the arm's position: the result must be the arm's position."""
    mover = Mover(probe) if probe.device.permissions.workspace else None
    for which in range(len(POSES)) if mover else (0,):
        if mover:
            mover.go(mover.pose(which))
        known = probe.device.known()
        given = [field.cases[0].numbers for field in probe.command.request[0].fields]
        if any(units(numbers) not in known for numbers in given):
            raise NotSupported("no query reports where the arm is")
        mine = _reading(probe, probe.command, *(known[units(numbers)] for numbers in given))
        reported = known[tuple(unit for _, unit, _ in mine)]
        wrong = [
            f"{name} is {value} {unit}, but the arm is at {actual}"
            for (name, unit, value), actual in zip(mine, reported)
            if abs(value - actual) > CALCULATED[unit]
        ]
        probe.expect(AGREES, not wrong, f"{probe.command.name}: {'; '.join(wrong)}")


AGREEMENT = Group(
    "agreement",
    (AGREES,),
    _agree,
    _has_equals,
    sends="The queries of the same quantity, one after the other, at rest.",
    subject="each query that reports the same quantity as another",
)
CALCULATION = Group(
    "calculation",
    (AGREES,),
    _calculate,
    _calculates,
    sends=(
        "The calculation with the position that the arm reports, at several poses if motion "
        "is permitted."
    ),
    subject="each query that calculates what the arm also reports",
)
