"""The coordinates of an end; an edition may have fewer than six of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cobotwire.kinematics import Pose
from cobotwire.protocol.table import Number

# Where a coordinate stands among x, y, z, rx, ry and rz, by its name in an edition.
PLACES = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5, "theta": 5}
ALL_SIX = (0, 1, 2, 3, 4, 5)


def places_of(numbers: Iterable[Number]) -> tuple[int, ...] | None:
    """Return where the numbers of a row stand among the six; None if one is no coordinate."""
    places = tuple(PLACES.get(number.name, -1) for number in numbers)
    return None if -1 in places else places


def pose_with(values: Sequence[float], places: Sequence[int], other: Pose | None) -> Pose:
    """Return the pose with some coordinates, and the rest of another pose's."""
    coords = [0.0] * 6 if other is None else list(other.coords)
    for place, value in zip(places, values):
        coords[place] = value
    return Pose.of(coords)
