"""What an arm is like when it has just been switched on, as its edition states it."""

from __future__ import annotations

from cobotwire.protocol.roles import row_index
from cobotwire.protocol.table import Number, Table
from cobotwire.simulator.coordinates import ALL_SIX, places_of
from cobotwire.simulator.kinematics.ticks import Steps

Limits = list[tuple[float, float]]


def joint_limits(table: Table) -> Limits:
    """Return the limits of each joint: the ranges of targets, or else those that are stated.

    A range that holds every number of the wire is no limit. Empty: the edition states no limit.
    """
    return _ranges(table) or list(table.robot.joint_limits)


def _ranges(table: Table) -> Limits:
    command = table.find_role("joint targets")
    if command is None:
        return []
    variant = command.request[0]
    numbers = variant.fields[row_index(variant)].cases[0].numbers
    if any(number.raw_range == (number.minimum, number.maximum) for number in numbers):
        return []
    return [(n.physical(n.minimum), n.physical(n.maximum)) for n in numbers]


def coordinates(table: Table) -> tuple[int, ...]:
    """Return where the coordinates of an edition stand among x, y, z, rx, ry and rz."""
    query = table.find_role("coordinates")
    if query is None or not query.reply:
        return ALL_SIX
    return places_of(query.reply[0].fields[-1].cases[0].numbers) or ALL_SIX


def steps(table: Table) -> Steps:
    """Return the steps in which an edition reports angles and coordinates."""
    angle, coords = 0.0, [0.0] * 6
    joints, end = table.find_role("joints"), table.find_role("coordinates")
    if joints is not None and joints.reply:
        angle = _steps_of(joints.reply[0].fields[-1].cases[0].numbers[0])
    if end is not None and end.reply:
        numbers = end.reply[0].fields[-1].cases[0].numbers
        for place, number in zip(coordinates(table), numbers):
            coords[place] = _steps_of(number)
    return Steps(angle, tuple(coords))


def _steps_of(number: Number) -> float:
    return 0.0 if number.encoding == "float" else number.divide / number.multiply
