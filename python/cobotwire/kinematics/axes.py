"""Turn a chain of joints with any axes into Denavit-Hartenberg links with the same flange.

A link reaches from the axis of its joint along the common normal to the next axis. If two axes are
nearly parallel, their common normal is far away. Then two links replace it; the second one does not
move.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from cobotwire.kinematics.geometry import Link
from cobotwire.kinematics.pose import Pose
from cobotwire.protocol.robot import Shares

# Sines of the angle between two axes: below the first they are parallel, below the second nearly.
PARALLEL, NEARLY_PARALLEL = 1e-11, 0.1
# Below this distance, in millimetres, the next frame begins on the axis.
ON_AXIS = 1e-9


class Axis(NamedTuple):
    """The z axis of a frame that joints turn, and the frame of the next axis relative to it.

    ``turned_by`` is as in a ``Link``; ``offset`` is added to the angle, in degrees.
    """

    turned_by: Shares
    offset: float
    following: Pose


def links_of(axes: Iterable[Axis]) -> tuple[Link, ...]:
    """Return the links from the base to the flange; the first axis is that of the base."""
    links: list[Link] = []
    # The turn of the next frame about its own z axis, and its shift along it; both are added to the
    # next link.
    turn = shift = 0.0
    for turned_by, offset, following in axes:
        (first, *others), turn_after, shift_after = _between(following)
        turn, shift = first.offset + offset + turn, first.d + shift
        if turned_by or first.a or first.alpha:
            links.append(replace(first, offset=turn, d=shift, turned_by=turned_by))
            turn = shift = 0.0
        turn, shift = turn + turn_after, shift + shift_after
        links += others
    if abs(math.remainder(turn, 360)) > 1e-9 or abs(shift) > ON_AXIS:
        links.append(Link(turn, 0.0, 0.0, shift, ()))
    return tuple(_tidied(link, index) for index, link in enumerate(links))


def _between(pose: Pose) -> tuple[list[Link], float, float]:
    """Return the links from an axis to the next frame's axis, and the remaining turn and shift.

    The pose is Rz(turn) Tz(d) Tx(a) Rx(alpha) Rz(left) Tz(shift).
    """
    (xx, xy, xz), _, (zx, zy, zz), (px, py, pz) = pose
    sine, a = math.hypot(zx, zy), math.hypot(px, py)
    alpha, turn = math.atan2(sine, zz), math.atan2(zx, -zy)
    first = shift = 0.0
    links = []
    if sine > NEARLY_PARALLEL:
        a = px * math.cos(turn) + py * math.sin(turn)
        shift = (px * math.sin(turn) - py * math.cos(turn)) / sine
    elif sine < PARALLEL:
        alpha = 0.0 if zz > 0 else math.pi
        turn = math.atan2(py, px) if a > ON_AXIS else math.atan2(xy, xx)
    elif a > ON_AXIS:
        first = math.atan2(py, px)
        links.append(Link(math.degrees(first), 0.0, a, pz, ()))
        a = pz = 0.0
    c, s = math.cos(turn), math.sin(turn)
    left = math.atan2(math.cos(alpha) * (xy * c - xx * s) + math.sin(alpha) * xz, xx * c + xy * s)
    if abs(left) > math.pi / 2 + 1e-9:
        # With the other direction of the common normal, a smaller turn is left.
        turn, alpha, a, left = turn + math.pi, -alpha, -a, left + math.pi
    links.append(Link(math.degrees(turn - first), math.degrees(alpha), a, pz - shift * zz, ()))
    return links, math.degrees(left), shift


def _tidied(link: Link, index: int) -> Link:
    """Return a link without rounding errors: a right angle is 90 degrees again."""
    turn, alpha = (round(math.remainder(angle, 360), 9) for angle in (link.offset, link.alpha))
    turned_by = None if link.turned_by == ((index, 1.0),) else link.turned_by
    return Link(turn + 0.0, alpha + 0.0, round(link.a, 9) + 0.0, round(link.d, 9) + 0.0, turned_by)
