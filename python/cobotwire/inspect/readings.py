"""What an arm reports of its states, and the relations that hold between such readings.

The relations come from the table: which queries report the same state, the unit of each number, the
links, encoders and limits that the edition states.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import combinations
from typing import NamedTuple

from cobotwire.kinematics.forward import coords_of
from cobotwire.kinematics.geometry import geometry_of
from cobotwire.kinematics.pose import Pose
from cobotwire.protocol.effects import Reports, effect_of
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.numbers import Number
from cobotwire.protocol.roles import row_index
from cobotwire.protocol.table import Command, Field, Table

# The name of a reading, as in facts: the command, and ``reply.FIELD`` or ``request.ARGUMENT``. The
# row of a query with the argument joint has a number for each joint.
Key = tuple[str, str]
Row = tuple[float, ...]
# The readings at one time, while the arm rests.
Snapshot = Mapping[Key, Row]

# How far two readings of a quantity may be apart, by unit: a joint at rest jitters by a tick.
APART = {"": 0.0, "degree": 0.2, "millimetre": 1.0, "tick": 2.0}
# The links of an arm differ a little from those that the edition states.
LINKS_APART, LINKS_TURNED = 15.0, 5.0
# How far an angle may be beyond a limit, and a reported limit from a stated one, in degrees.
BEYOND, LIMIT_APART = 5.0, 1.0
# The plausible readings of a robot on a desk, by unit; a part that is not connected reads 0.
PLAUSIBLE = {"volt": (3.0, 60.0), "degree_celsius": (1.0, 110.0), "percent": (0.0, 110.0)}
# Unless each of these states has its first choice, the coordinates are not those of the flange.
FRAMES = ("reference_frame", "end_type")


class Source(NamedTuple):
    """A field of a query's reply that reports a state."""

    query: Command
    field: Field
    state: str
    of_joint: bool
    joints: int

    @property
    def key(self) -> Key:
        """The name of the reading."""
        return self.query.name, f"reply.{self.field.name}"

    @property
    def numbers(self) -> tuple[Number, ...]:
        """How each number of the row is sent."""
        numbers = self.field.cases[0].numbers
        return numbers * self.joints if self.of_joint else numbers

    @property
    def units(self) -> tuple[str, ...]:
        """The unit of each number of the row."""
        return tuple(number.unit for number in self.numbers)


class Relation(NamedTuple):
    """A relation that readings have if the edition is right.

    ``holds`` takes the rows of the ``keys``, then those of ``conditions``, which it does not
    test. ``independent`` is whether the readings differ in kind; then the relation also finds a
    mistake that all readings of one kind share. If the relation does not hold and no known mistake
    explains why, ``aspect`` is contradicted. A relation that is not ``exact`` gives only a range,
    which finds no wrong sign and no wrong order.
    """

    keys: tuple[Key, ...]
    text: str
    holds: Callable[..., bool]
    independent: bool = True
    aspect: str = "agreement"
    conditions: tuple[Key, ...] = ()
    exact: bool = True

    def fails(self, snapshot: Snapshot) -> bool:
        """Return whether the readings contradict it; False if one is missing."""
        rows = [snapshot.get(key) for key in (*self.keys, *self.conditions)]
        return None not in rows and not self.holds(*rows)


def sources(table: Table) -> list[Source]:
    """Return the state that each query of an edition reports, for all joints or joint by joint."""
    found = []
    for query in table.commands:
        effect = effect_of(query)
        known = isinstance(effect, Reports) and not effect.assumed and not query.event
        if not known or query.safety != "query" or not query.reply:
            continue
        assert isinstance(effect, Reports)
        arguments = query.request[0].fields
        of_joint = effect.at == ("joint",) and len(arguments) == 1
        if arguments and not of_joint:
            continue
        found += [
            Source(query, field, effect.values[field.name], of_joint, table.joints)
            for field in query.reply[0].fields
            if field.name in effect.values and _is_row(field) and not (of_joint and field.many)
        ]
    return found


def _is_row(field: Field) -> bool:
    plain = field.kind not in ("bytes", "text") and not field.each and not field.sizes
    return plain and field.selector < 0 and not any(n.bits for n in field.numbers)


def relations(table: Table) -> list[Relation]:
    """Return the relations between the readings of an edition."""
    every = sources(table)
    return [
        *_of_targets(table),
        *(found for one, two in combinations(every, 2) for found in _of_pair(table, one, two)),
        *_of_geometry(table, every),
        *_of_limits(table, every),
        *(_plausible(source) for source in every if {*source.units} & {*PLAUSIBLE}),
    ]


def target_of(table: Table) -> tuple[Key, tuple[Number, ...]] | None:
    """Return the argument that holds the targets of all joints, and its numbers."""
    command = table.find_role("joint targets")
    at = -1 if command is None else row_index(command.request[0])
    if command is None or at < 0:
        return None
    field = command.request[0].fields[at]
    return (command.name, f"request.{field.name}"), field.cases[0].numbers


def _of_targets(table: Table) -> Iterator[Relation]:
    """Yield the relation that an arm at rest is where it was sent."""
    target, query = target_of(table), table.find_role("joints")
    if target is not None and query is not None and query.reply:
        angles = query.name, f"reply.{query.reply[0].fields[0].name}"
        near, text = [2 * APART["degree"]] * len(target[1]), f"{query.name} reports the target"
        yield Relation((target[0], angles), text, lambda a, b: _close(a, b, near), False)


def _of_pair(table: Table, one: Source, two: Source) -> Iterator[Relation]:
    """Yield what holds between two readings of the same state."""
    agree = two.query.name in one.query.agrees_with or one.query.name in two.query.agrees_with
    if one.query is two.query or not (one.state == two.state or agree):
        return
    keys, text = (one.key, two.key), f"{one.query.name} and {two.query.name} agree"
    if one.units == two.units and {*one.units} <= {*APART}:
        near = [APART[unit] for unit in one.units]
        differ = one.numbers[0].divide != two.numbers[0].divide
        yield Relation(keys, text, lambda a, b: _close(a, b, near), differ)
    elif one.of_joint != two.of_joint and {one.field.kind, two.field.kind} == {"flag"}:
        whole, parts = (two, one) if one.of_joint else (one, two)
        keys, text = (whole.key, parts.key), f"{whole.query.name} sums up {parts.query.name}"
        yield Relation(keys, text, lambda a, b: all(a) == all(b))
    for ticks, angles in ((one, two), (two, one)):
        if {*ticks.units} == {"tick"} and {*angles.units} == {"degree"} and table.robot.encoders:
            yield _of_encoders(table, ticks, angles)


def _of_encoders(table: Table, ticks: Source, angles: Source) -> Relation:
    encoders = table.robot.encoders
    assert encoders is not None

    def holds(counted: Row, row: Row) -> bool:
        found = tuple(encoders.angle(at, int(count)) for at, count in enumerate(counted))
        if not encoders.signs:
            # The direction of the encoders is not known.
            found, row = tuple(map(abs, found)), tuple(map(abs, row))
        return _close(found, row, [encoders.degrees + 0.1] * len(row))

    text = f"{ticks.query.name} and {angles.query.name} agree"
    return Relation((ticks.key, angles.key), text, holds)


def _of_geometry(table: Table, every: list[Source]) -> Iterator[Relation]:
    """Yield what holds between angles and coordinates, by the links that the edition states."""
    geometry = geometry_of(table)
    angles = [s for s in every if s.query.role == "joints" and s.state == "angles"]
    coords = [s for s in every if s.query.role == "coordinates" and s.state == "coords"]
    frames = tuple(source.key for source in every if source.state in FRAMES)
    for one, two in zip(angles[:1] if geometry else (), coords[:1]):
        assert geometry is not None

        def holds(row: Row, place: Row, *chosen: Row) -> bool:
            if any(map(any, chosen)):
                return True
            apart, turned = Pose.of(coords_of(geometry, row)).distance(Pose.of(place))
            return apart <= LINKS_APART and turned <= LINKS_TURNED

        if two.units == ("millimetre",) * 3 + ("degree",) * 3:
            text = f"{two.query.name} follows from {one.query.name} by the stated links"
            yield Relation((one.key, two.key), text, holds, conditions=frames)


def _of_limits(table: Table, every: list[Source]) -> Iterator[Relation]:
    """Yield what holds between angles, limits that the arm reports and limits that are stated."""
    stated, degrees = joint_limits(table), ("degree",) * table.joints
    by_state = {
        state: [source for source in every if source.state == state and source.units == degrees]
        for state in ("angles", "lowest", "highest")
    }
    for low, high in zip(by_state["lowest"], by_state["highest"]):
        text = f"{low.query.name} is below {high.query.name}"
        yield Relation((low.key, high.key), text, _below, aspect="limits", exact=False)
        for angles in by_state["angles"][:1]:
            text = f"{angles.query.name} is within {low.query.name} and {high.query.name}"
            keys = low.key, angles.key, high.key
            yield Relation(keys, text, _between, aspect="limits", exact=False)
    if not stated or len(stated) != table.joints:
        return
    lowest, highest = zip(*stated)
    within = partial(_inside, lowest, highest)
    for angles in by_state["angles"]:
        text = f"{angles.query.name} is within the stated limits"
        yield Relation((angles.key,), text, within, aspect="limits", exact=False)
    near = [LIMIT_APART] * table.joints
    for state, side in (("lowest", lowest), ("highest", highest)):
        for source in by_state[state]:
            text = f"{source.query.name} reports the stated limits {_short(side)}"
            yield Relation((source.key,), text, partial(_close, side, near=near), aspect="limits")


def _plausible(source: Source) -> Relation:
    low, high = PLAUSIBLE[next(unit for unit in source.units if unit in PLAUSIBLE)]
    text = f"{source.query.name} reports {low:g} to {high:g} {source.numbers[0].units}"

    def holds(row: Row) -> bool:
        return all(not value or low <= value <= high for value in row)

    return Relation((source.key,), text, holds, exact=False)


def _close(one: Row, two: Row, near: list[float]) -> bool:
    return all(abs(a - b) <= most for a, b, most in zip(one, two, near))


def _below(low: Row, high: Row) -> bool:
    return all(a <= b for a, b in zip(low, high))


def _between(low: Row, row: Row, high: Row) -> bool:
    return all(a - BEYOND <= v <= b + BEYOND for a, v, b in zip(low, row, high))


def _inside(low: Row, high: Row, row: Row) -> bool:
    return _between(low, row, high)


def _short(row: Row) -> str:
    return ", ".join(f"{value:g}" for value in row)
