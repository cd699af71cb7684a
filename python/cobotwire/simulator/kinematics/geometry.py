"""The geometry of an arm, as the kinematics use it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from cobotwire.protocol.table import Table


@dataclass(frozen=True)
class Link:
    """A row of standard Denavit-Hartenberg parameters, in degrees and millimetres."""

    offset: float
    alpha: float
    a: float
    d: float

    @cached_property
    def turned(self) -> tuple[float, float]:
        """Cosine and sine of alpha: like the firmware's, they are not rounded to 0 and 1."""
        alpha = math.radians(self.alpha)
        return math.cos(alpha), math.sin(alpha)


@dataclass(frozen=True)
class Geometry:
    """An arm with six joints; the second to the fourth are parallel (see ``inverse``).

    Attributes:
        links: the links, from the base on.
        encoder_signs: for each joint, whether its encoder counts up (+1) or down (-1) while the
            angle grows.
    """

    links: tuple[Link, ...]
    encoder_signs: tuple[int, ...]


# The inverse kinematics are limited to these axes: alpha of each link, in degrees.
SOLVED_AXES = (90, 0, 0, 90, -90, 0)


def geometry_of(table: Table) -> Geometry | None:
    """Return the geometry that an edition states; None if it states none, or one of another kind.

    A geometry is of another kind if its axes are not those that ``inverse`` solves.
    """
    stated = table.geometry
    if stated is None or tuple(alpha for _, alpha, _, _ in stated.links) != SOLVED_AXES:
        return None
    return Geometry(tuple(Link(*link) for link in stated.links), stated.encoder_signs)
