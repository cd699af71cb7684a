"""The geometry of an arm: its links, and the directions of its encoders."""

from __future__ import annotations

from cobotwire_codegen.language.number_shapes import Numbers, Real
from cobotwire_codegen.language.records import Listed, Record, required
from cobotwire_codegen.language.shapes import Text


class Link(Record):
    """A row of standard Denavit-Hartenberg parameters."""

    offset = required(Real(), "What is added to the joint's angle, in degrees.")
    alpha = required(Real(), "The angle between the axes of this joint and the next, in degrees.")
    a = required(Real(), "The distance between these axes, in millimetres.")
    d = required(Real(), "The shift along the axis of this joint, in millimetres.")
    EXAMPLE = "{offset: -90, alpha: 0, a: -110.4, d: 0}"


class Geometry(Record):
    """The geometry of the arm, by which a simulated arm calculates coordinates."""

    links = required(Listed(Link), "The links from the base on, one for each joint.")
    encoder_signs = required(
        Numbers(), "For each joint: 1 if its encoder counts up while the angle grows, else -1."
    )
    doc = required(Text(), "Where the geometry is taken from.")
    EXAMPLE = """\
links:
  - {offset: 0, alpha: 90, a: 0, d: 131.22}
  - {offset: -90, alpha: 0, a: -110.4, d: 0}
encoder_signs: [-1, 1]
doc: Measured on an arm with two joints.
"""


class Motion(Record):
    """How the arm moves; a simulated arm moves like that."""

    speed = required(Real(), "Degrees a second for each percent of speed.")
    fastest = required(Real(), "The highest speed of a joint, in degrees a second.")
    acceleration = required(Real(), "The highest acceleration, in degrees a square second.")
    doc = required(Text(), "Where the numbers are taken from.")
    EXAMPLE = """\
speed: 1.5
fastest: 150
acceleration: 200
doc: Measured on an arm.
"""
