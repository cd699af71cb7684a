"""What an edition states about its robot for simulation: everything except its messages."""

from __future__ import annotations

from cobotwire_codegen.language.number_shapes import Exact, Numbers, Real, Whole
from cobotwire_codegen.language.records import Listed, Named, Record, optional, required
from cobotwire_codegen.language.shapes import Text

NUMBER = r"[0-9]{1,3}"


class Link(Record):
    """The standard Denavit-Hartenberg parameters of one link."""

    offset = required(Real(), "What is added to the joint's angle, in degrees.")
    alpha = required(Real(), "The angle between the axes of this joint and the next, in degrees.")
    a = required(Real(), "The distance between these axes, in millimetres.")
    d = required(Real(), "The shift along the axis of this joint, in millimetres.")
    turned_by = optional(
        Named(Real(), NUMBER),
        "For each joint (counted from 1) that rotates this link, the degrees that the link rotates "
        "per degree of the joint: `{2: -1, 3: -1}` for an end that stays level, `{}` for a fixed "
        "link. Left out: 1 for the next joint, one after the highest joint named so far.",
    )
    EXAMPLE = "{offset: -90, alpha: 0, a: -110.4, d: 0}"


class Geometry(Record):
    """The geometry of the arm, by which a simulated arm calculates coordinates."""

    links = required(Listed(Link), "The links from the base on: one or more for each joint.")
    doc = required(Text(), "Where the geometry is taken from.")
    EXAMPLE = """\
links:
  - {offset: 0, alpha: 90, a: 0, d: 131.22}
  - {offset: -90, alpha: 0, a: -110.4, d: 0}
doc: Measured on an arm with two joints.
"""


class Motion(Record):
    """How the arm moves, and so how it is simulated."""

    speed = required(Real(), "Degrees a second for each percent of speed.")
    fastest = required(Real(), "The highest speed of a joint, in degrees a second.")
    acceleration = required(Real(), "The highest acceleration, in degrees per second squared.")
    near_degrees = optional(
        Exact(), "A joint this close to its target, in degrees, has reached it."
    )
    near_millimetres = optional(
        Exact(), "An end this close to its target, in millimetres, has reached it."
    )
    doc = required(Text(), "Where the numbers are taken from.")
    EXAMPLE = """\
speed: 1.5
fastest: 150
acceleration: 200
doc: Measured on an arm.
"""


class Encoders(Record):
    """How the encoders of the joints count; a joint of a simulated arm always stops on a tick."""

    ticks = required(Whole(1), "The ticks of a whole turn.")
    zero = required(Whole(0), "The reading of a joint at 0 degrees.")
    highest = required(Whole(1), "The highest reading; the lowest is 0.")
    signs = optional(
        Numbers(),
        "For each joint: 1 if its encoder counts up while the angle grows, else -1. Left out: not "
        "known; a simulated arm counts up.",
    )
    doc = required(Text(), "Where the numbers are taken from.")
    EXAMPLE = "{ticks: 4096, zero: 2048, highest: 4095, signs: [1, -1], doc: Measured on an arm.}"


class Gripper(Record):
    """The gripper of a simulated arm."""

    speed = required(Exact(), "Percent of its full stroke a second, for each percent of speed.")
    closed = required(Whole(0), "The reading of its encoder when it is closed.")
    open_ = required(Whole(0), "The reading of its encoder when it is open.")
    doc = required(Text(), "Where the numbers are taken from.")
    EXAMPLE = "{speed: 1.5, closed: 2048, open: 2148, doc: Chosen; no source gives them.}"


class Servos(Record):
    """What the servos of a simulated arm report."""

    registers = optional(
        Named(Whole(0), NUMBER), "The registers by address, and their initial values."
    )
    doc = required(Text(), "Where the numbers are taken from.")
    EXAMPLE = "{registers: {21: 10}, doc: The chart of registers.}"


class ErrorCodes(Record):
    """The error codes that a simulated arm reports when it rejects a motion."""

    joint_limits = required(Numbers(), "For each joint, the code for a target beyond its limit.")
    no_solution = required(Whole(1), "No joint angles bring the end of the arm to the target.")
    no_straight_line = required(Whole(1), "The joints cannot follow a straight line.")
    stopped = optional(Whole(0), "A motion was stopped before its target. 0: it has no code.")
    no_power = optional(Whole(0), "The arm has no power, or not every joint is held. 0: no code.")
    doc = required(Text(), "Where the numbers are taken from.")
    EXAMPLE = "{joint_limits: [1, 2], no_solution: 32, no_straight_line: 33, doc: Its manual.}"


ROBOT_RECORDS = (Geometry, Link, Motion, Encoders, Gripper, Servos, ErrorCodes)
