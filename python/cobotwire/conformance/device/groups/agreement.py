"""Compare queries of the same quantity while the arm rests, if possible away from zero."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.mover import POSES, Mover, angle_tolerance
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.requests import as_row, request_of
from cobotwire.conformance.device.same_pose import is_same_pose
from cobotwire.conformance.device.selection import does
from cobotwire.conformance.located import located_numbers
from cobotwire.conformance.mistakes import ANOTHER_ORDER, Pair, likely_mistake
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.effects import Computes
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Number, Role, Table

AGREES = TestCase("agrees", "While the arm rests, queries of the same quantity agree.")

# The tolerance between two readings of a quantity, by unit: a joint at rest jitters by a tick.
APART = {"millimetre": 1.0, "tick": 2.0}


class _Reported(NamedTuple):
    """A number that a query reports, with its name in messages."""

    name: str
    number: Number
    value: Any

    @property
    def unit(self) -> str:
        """The unit of the number."""
        return self.number.unit


def _has_equals(table: Table, command: Command) -> bool:
    """Return whether other queries report the same quantity."""
    return bool(command.agrees_with)


def _agree(probe: Probe) -> None:
    """Compare the query with each other query of the quantity, number by number."""
    if probe.device.permissions.workspace:
        mover = Mover(probe.device)
        mover.go(mover.pose(0))
    for name in probe.command.agrees_with:
        other = probe.device.table.command(name)
        theirs = _reading(probe, other.request_type())
        if probe.command.request[0].fields:
            theirs = theirs[: probe.device.table.joints]
            queries = [request_of(probe.command, joint) for joint in range(1, len(theirs) + 1)]
            mine = [_matching(_reading(probe, q), [one]) for q, one in zip(queries, theirs)]
            pairs = [(found[0], one) for found, one in zip(mine, theirs) if found]
        else:
            pairs = list(
                zip(_matching(_reading(probe, probe.command.request_type()), theirs), theirs)
            )
        if pairs:
            _compare(probe, other, pairs)


def _reading(probe: Probe, query: Request[Any]) -> list[_Reported]:
    """Return the numbers of a query's reply, without those that repeat its arguments.

    A reply with values that are not allowed fails the test case.

    Raises:
        NotSupported: no valid reply comes.
    """
    response = probe.device.request(query)
    valid = response.valid
    if valid is None and response.replies:
        call = probe.device.requester.describe(response.request)
        error = response.replies[0].error
        probe.expect(AGREES, False, f"{call}: expected legal values; {error or response.summary}")
    if valid is None or valid.decoded is None:
        raise NotSupported(f"{query.command} reports nothing")
    fields = valid.decoded.fields
    of = f"({', '.join(map(str, query.values))})" if query.values else ""
    return [
        _Reported(
            located.name + of, located.number, as_row(fields[located.field.name])[located.element]
        )
        for located in located_numbers(valid.decoded.variant)
        if not located.field.echo
    ]


def _compare(probe: Probe, other: Command, pairs: list[tuple[_Reported, _Reported]]) -> None:
    """Compare two readings, number by number, in the same unit; the first is taken as right."""
    table, compared, wrong = probe.device.table, list[Pair](), list[str]()
    encoders, near = table.robot.encoders, {**APART, "degree": angle_tolerance(table) + 0.001}
    for one, two in pairs:
        pair = Pair(two.name, one.value, two.value, near.get(two.unit, 0.0), two.number)
        if one.unit == "tick" and two.unit == "degree":
            # Without a statement about encoders, nothing says what a tick is.
            if encoders is None:
                continue
            # The direction of an encoder may be unknown.
            degrees = abs(one.value - encoders.zero) * encoders.degrees
            pair = Pair(two.name, degrees, abs(two.value), near["degree"])
        compared.append(pair)
        if pair.wrong:
            theirs = f"{other.name} reports {two.name} = {two.value} {two.unit}"
            wrong.append(f"{one.name} is {one.value} {one.unit}, but {theirs}")
    reason = f"{probe.command.name}: {'; '.join(wrong)}{_likely(probe.command, other, compared)}"
    probe.expect(AGREES, not wrong, reason)


def _likely(mine: Command, other: Command, compared: list[Pair]) -> str:
    """Return the likely mistake of the other query, or else of this one."""
    guesses = [
        (mine, other, likely_mistake(compared)),
        (other, mine, likely_mistake([pair.exchanged for pair in compared])),
    ]
    # These two guesses do not depend on which query is right, so any other guess comes first.
    guesses.sort(key=lambda guess: guess[2] in ("", ANOTHER_ORDER))
    right, wrong, mistake = guesses[0]
    return f"; if {right.name} is right, {wrong.name} has {mistake}" if mistake else ""


def _matching(mine: list[_Reported], theirs: list[_Reported]) -> list[_Reported]:
    """Return the numbers of a reading that have the same units as the other, in the same order."""
    units = [each.unit for each in theirs]
    for at in range(len(mine) - len(units) + 1):
        if [each.unit for each in mine[at : at + len(units)]] == units:
            return mine[at : at + len(units)]
    return mine if len(mine) == len(theirs) else []


# The tolerance between calculated and reported numbers, by unit, because joints rest on ticks.
# Angles that differ by more may still be the same pose.
CALCULATED = {"degree": 3.0, "millimetre": 2.5}
# The roles of the queries that report what is calculated.
PLACES: dict[str, Role] = {"angles": "joints", "coords": "coordinates"}
COMPUTES = does(Computes)


def _calculate(probe: Probe, computes: Computes) -> None:
    """Have the arm calculate its angles from its coordinates, or the reverse, and compare."""
    device = probe.device
    mover = Mover(device) if device.permissions.workspace else None
    for which in range(len(POSES)) if mover else (0,):
        if mover:
            mover.go(mover.pose(which))
        known = {name: _position(device, role) for name, role in PLACES.items()}
        arguments = {computes.source: known["coords" if computes.what == "angles" else "angles"]}
        if computes.near:
            arguments[computes.near] = known["angles"]
        right = known[computes.what]
        if not right or not all(arguments.values()):
            raise NotSupported("no query reports where the arm is")
        mine = _reading(probe, probe.command.request_type.from_fields(arguments))
        wrong = [
            f"{each.name} is {each.value} {each.unit}, but the arm is at {actual}"
            for each, actual in zip(mine, right)
            if abs(each.value - actual) > CALCULATED[each.unit]
        ]
        values = [each.value for each in mine]
        if wrong and computes.what == "angles" and is_same_pose(device.table, values, right):
            continue
        probe.expect(AGREES, not wrong, f"{probe.command.name}: {'; '.join(wrong)}")


def _position(device: Device, role: Role) -> tuple[float, ...]:
    """Return the numbers that the query in a role reports; empty without a valid reply."""
    query = device.command(role)
    reply = None if query is None else device.read(query.request_type())
    return () if reply is None else tuple(reply.result)


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
    *for_found(COMPUTES, _calculate),
    sends=(
        "The calculation with the position that the arm reports, at several poses if motion "
        "is permitted."
    ),
    subject="each query that calculates what the arm also reports",
)
