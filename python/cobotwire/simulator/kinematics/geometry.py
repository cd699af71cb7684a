"""The known geometries, as data. Only this file knows the names of robots."""

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
        editions: the editions of the protocol that the arm speaks.
        links: the links, from the base on.
        encoder_signs: for each joint, whether its encoder counts up (+1) or down (-1) while the
            angle grows.
    """

    editions: tuple[str, ...]
    links: tuple[Link, ...]
    encoder_signs: tuple[int, ...]


# Source: the protocol notes on kinematics (kinematics.md), for firmware 6.5. The maker's web page
# prints other lengths for an older arm (d4 63.4, d5 75.05, d6 45.6); the recorded pairs fit only
# the lengths below.
MYCOBOT_280 = Geometry(
    ("mycobot", "mycobot280"),
    (
        Link(offset=0, alpha=90, a=0, d=131.22),
        Link(offset=-90, alpha=0, a=-110.4, d=0),
        Link(offset=0, alpha=0, a=-96, d=0),
        Link(offset=-90, alpha=90, a=0, d=64.62),
        Link(offset=90, alpha=-90, a=0, d=73.18),
        Link(offset=0, alpha=0, a=0, d=48.6),
    ),
    encoder_signs=(-1, -1, 1, -1, -1, -1),
)
KNOWN = (MYCOBOT_280,)


def geometry_of(table: Table) -> Geometry | None:
    """Return the geometry of the arm that speaks an edition; None: it is not known."""
    for one in KNOWN:
        if table.edition in one.editions and table.joints == len(one.links):
            return one
    return None
