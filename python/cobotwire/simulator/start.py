"""The coordinates of an arm, and the steps in which it reports, as its edition states them."""

from __future__ import annotations

from cobotwire.kinematics.coordinates import ALL_SIX, indices_of
from cobotwire.kinematics.ticks import Steps
from cobotwire.protocol.table import Number, Table


def coordinates(table: Table) -> tuple[int, ...]:
    """Return the index in x, y, z, rx, ry, rz of each coordinate of an edition."""
    query = table.find_role("coordinates")
    if query is None or not query.reply:
        return ALL_SIX
    return indices_of(query.reply[0].fields[-1].cases[0].numbers) or ALL_SIX


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
