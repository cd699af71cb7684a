"""The rounding of what the firmware reports: it truncates to the steps of the wire."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from cobotwire.protocol.robot import Encoders


class Steps(NamedTuple):
    """How many raw values of a reply make a unit; 0: the reply is a float, and is not truncated.

    Attributes:
        angle: raw values per degree of a joint.
        coords: raw values per millimetre or degree of x, y, z, rx, ry and rz.
    """

    angle: float = 0.0
    coords: tuple[float, ...] = (0.0,) * 6


def reported_angles(
    encoders: Encoders, degrees: Iterable[float], steps: Steps
) -> tuple[float, ...]:
    """Return angles as the firmware reports them: on ticks, truncated."""
    return tuple(_truncated(encoders.on_tick(angle), steps.angle) for angle in degrees)


def reported_coords(coords: Iterable[float], steps: Steps) -> tuple[float, ...]:
    """Return six coordinates as the firmware reports them: truncated."""
    return tuple(_truncated(value, step) for value, step in zip(coords, steps.coords))


def _truncated(value: float, step: float) -> float:
    return math.trunc(value * step) / step if step else value
