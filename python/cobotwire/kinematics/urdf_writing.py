"""Write the arm of an edition as a URDF: links, joints with their limits, simple shapes.

The frame of ``link1`` stands on the axis of the first joint and turns with it, and so on. The arm
reports the coordinates of ``flange``. Lengths are in metres, angles in radians.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from cobotwire.kinematics.geometry import Link, geometry_of
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.table import Table

# No source gives the thickness of links, in metres.
RADIUS = "0.02"
STILL = Link(0, 0, 0, 0)
NOTE = (
    " Limits and speeds are those of the edition. Efforts, masses and the thickness of the shapes "
    "are not known: an effort or a velocity of 0 is not a limit. "
)
PREFIX = re.compile(r"([A-Za-z][A-Za-z0-9_]*)?")


def write_urdf(table: Table, prefix: str = "") -> str:
    """Return the URDF of the edition's arm; ``prefix`` begins the name of each link and joint.

    Raises:
        UsageError: the geometry of the arm is not known, or has coupled links, or ``prefix`` is
            not a name.
    """
    if not PREFIX.fullmatch(prefix):
        raise UsageError("prefix", prefix, "letters, digits and _, a letter first")
    geometry, why = geometry_of(table), table.robot.why_no_geometry
    if geometry is None or geometry.coupled:
        why = "not every link is turned by its own joint alone" if geometry else why
        raise UsageError("edition", table.edition, message=f"edition {table.edition}: {why}")
    robot = Element("robot", name=table.edition)
    robot.append(ElementTree.Comment(NOTE))
    parent, before = f"{prefix}base", STILL
    SubElement(robot, "link", name=parent)
    for number, link in enumerate([*geometry.links, STILL], 1):
        end = number > geometry.joints
        added = SubElement(robot, "joint", name=f"{prefix}end" if end else f"{prefix}j{number}")
        child = f"{prefix}flange" if end else f"{prefix}link{number}"
        SubElement(added, "parent", link=parent)
        SubElement(added, "child", link=child)
        place, turned = _end(before)
        _origin(added, place, (math.radians(before.alpha), 0, turned))
        if end:
            added.set("type", "fixed")
        else:
            _move(added, table, number - 1)
        _show(SubElement(robot, "link", name=child), link)
        parent, before = child, link
    ElementTree.indent(robot)
    return f'<?xml version="1.0"?>\n{ElementTree.tostring(robot, encoding="unicode")}\n'


def _move(added: Element, table: Table, joint: int) -> None:
    """State how a joint moves; joints count from 0."""
    limits, motion = joint_limits(table), table.robot.motion
    added.set("type", "revolute" if limits else "continuous")
    SubElement(added, "axis", xyz="0 0 1")
    fastest = 0.0 if motion is None else motion.fastest
    limit = SubElement(added, "limit", effort="0", velocity=_text([math.radians(fastest)]))
    for name, angle in zip(("lower", "upper"), limits[joint] if limits else ()):
        limit.set(name, _text([math.radians(angle)]))


def _show(shown: Element, link: Link) -> None:
    """Add a cylinder along each length of a link."""
    (x, y, z), turned = _end(link)
    across = (x / 2, y / 2, z), (0, math.pi / 2, turned)
    for length, (centre, direction) in ((link.d, ((0, 0, z / 2), (0, 0, 0))), (link.a, across)):
        if length:
            visual = SubElement(shown, "visual")
            _origin(visual, centre, direction)
            shape = SubElement(visual, "geometry")
            SubElement(shape, "cylinder", radius=RADIUS, length=_text([abs(length) / 1000]))


def _end(link: Link) -> tuple[tuple[float, float, float], float]:
    """Return where a link ends in its own frame, and how far the next frame is turned about z."""
    turned = math.radians(link.offset)
    return (link.a * math.cos(turned), link.a * math.sin(turned), link.d), turned


def _origin(parent: Element, place: Iterable[float], turned: Iterable[float]) -> None:
    SubElement(parent, "origin", xyz=_text(x / 1000 for x in place), rpy=_text(turned))


def _text(numbers: Iterable[float]) -> str:
    # Rounding errors of cosines and sines of right angles are removed, and so is -0.0.
    return " ".join(f"{round(number, 15) + 0.0:.15g}" for number in numbers)
