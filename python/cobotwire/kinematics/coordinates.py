"""The coordinates of the flange; an edition may have fewer than six of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cobotwire.kinematics import Pose
from cobotwire.protocol.table import Number

# The index of each coordinate in (x, y, z, rx, ry, rz), by its name in an edition.
INDICES = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5, "theta": 5}
ALL_SIX = (0, 1, 2, 3, 4, 5)


def indices_of(numbers: Iterable[Number]) -> tuple[int, ...] | None:
    """Return the indices of numbers among all six coordinates; None if one is not a coordinate."""
    indices = tuple(INDICES.get(number.name, -1) for number in numbers)
    return None if -1 in indices else indices


def pose_with(values: Sequence[float], indices: Sequence[int], other: Pose | None) -> Pose:
    """Return the pose with these coordinates, and the others from ``other``; None: they are 0."""
    coords = [0.0] * 6 if other is None else list(other.coords)
    for index, value in zip(indices, values):
        coords[index] = value
    return Pose.of(coords)
