"""States the geometry by pairs of angles and coordinates that a real arm reported."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from cobotwire_codegen.model import Edition, Geometry

# Angles in degrees, and the coordinates that the arm reported at them (firmware 6.5 of the 280).
PAIRS = (
    (
        (88.06, -138.33, 150.38, -151.96, 104.15, -13.71),
        (21.1, 108.9, 94.2, 75.19, 51.98, -114.61),
    ),
    ((95.18, -0.61, -0.61, -0.61, 88.85, -1.31), (15.3, 7.9, 410.7, -90.03, 0.52, 94.04)),
)
MILLIMETRES, DEGREES = 0.3, 0.1
ARM = "mycobot"  # and its deltas that state no geometry of their own


def geometry(edition: Edition) -> Iterator[str]:
    """Report links that put the end elsewhere than the arm reported, or no links at all."""
    if edition.name not in (ARM, "mycobot280"):
        return
    if edition.geometry is None:
        yield "the geometry of the arm is known, but the edition does not state it"
        return
    for angles, (x, y, z, *turns) in PAIRS:
        place, turned = _end(edition.geometry, angles)
        apart = float(np.abs(place - np.array([x, y, z])).max())
        reported = Rotation.from_euler("xyz", turns, degrees=True)
        off = float(np.degrees((turned.inv() * reported).magnitude()))
        if apart > MILLIMETRES or off > DEGREES:
            yield f"the end is {apart:.1f} mm and {off:.1f} degrees from where the arm reported it"


def _end(geometry: Geometry, angles: tuple[float, ...]) -> tuple[np.ndarray, Rotation]:
    place, turned = np.zeros(3), Rotation.identity()
    for angle, link in zip(angles, geometry.links):
        turned = turned * Rotation.from_euler("z", angle + float(link.offset), degrees=True)
        place = place + turned.apply([float(link.a), 0, float(link.d)])
        turned = turned * Rotation.from_euler("x", float(link.alpha), degrees=True)
    return place, turned


def motion(edition: Edition) -> Iterator[str]:
    """Report a simulated arm whose full speed is not its fastest, or that states no motion.

    The notes on kinematics say that a joint turns 1.5 degrees per second for each percent.
    """
    if edition.name not in (ARM, "mycobot280"):
        return
    if edition.motion is None:
        yield "the edition of a real arm does not state how it moves"
    elif edition.motion.speed * 100 != edition.motion.fastest:
        yield "100 percent of the speed is not the fastest motion"


RULES = (geometry, motion)
