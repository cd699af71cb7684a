"""The geometry of an arm, as the kinematics use it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from cobotwire.protocol.table import Table

Angles = tuple[float, ...]


@dataclass(frozen=True)
class Link:
    """A row of standard Denavit-Hartenberg parameters, in degrees and millimetres.

    ``turned_by`` lists the joints, counted from 0, that turn the link, each with the degrees that
    the link turns for one degree of the joint. None: the joint of the same number turns it.
    """

    offset: float
    alpha: float
    a: float
    d: float
    turned_by: tuple[tuple[int, float], ...] | None = None

    @cached_property
    def turned(self) -> tuple[float, float]:
        """Cosine and sine of alpha: like the firmware's, they are not rounded to 0 and 1."""
        alpha = math.radians(self.alpha)
        return math.cos(alpha), math.sin(alpha)


@dataclass(frozen=True)
class Geometry:
    """The links of an arm, from the base on."""

    links: tuple[Link, ...]

    @cached_property
    def coupled(self) -> bool:
        """Whether any link is turned by anything but the joint of its own number."""
        return any(link.turned_by is not None for link in self.links)

    @cached_property
    def turns(self) -> tuple[tuple[tuple[int, float], ...], ...]:
        """For each link, the joints that turn it, and by how much."""
        return tuple(
            ((index, 1.0),) if link.turned_by is None else link.turned_by
            for index, link in enumerate(self.links)
        )

    @cached_property
    def joints(self) -> int:
        """How many joints turn links."""
        return 1 + max(joint for turn in self.turns for joint, _ in turn)

    def link_angles(self, angles: Sequence[float]) -> Sequence[float]:
        """Return how far each link is turned when the joints are at ``angles``."""
        if not self.coupled:
            return angles
        return [sum(angles[joint] * share for joint, share in turn) for turn in self.turns]


def geometry_of(table: Table) -> Geometry | None:
    """Return the geometry that an edition states; None if it states none."""
    stated = table.robot.geometry
    return None if stated is None else Geometry(tuple(Link(*link) for link in stated.links))
