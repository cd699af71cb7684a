"""What an edition states about its robot for simulation: everything except its messages."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True, slots=True)
class Link:
    """The standard Denavit-Hartenberg parameters of one link, in degrees and millimetres.

    ``turned_by`` holds the joints that rotate the link, counted from 1, each with the degrees that
    the link rotates per degree of the joint.
    """

    offset: Fraction
    alpha: Fraction
    a: Fraction
    d: Fraction
    turned_by: tuple[tuple[int, Fraction], ...]


@dataclass(frozen=True, slots=True)
class Geometry:
    """The links of an arm, from the base on."""

    links: tuple[Link, ...]
    doc: str


@dataclass(frozen=True, slots=True)
class Motion:
    """How an arm moves, in degrees and seconds; ``speed`` is its speed at one percent."""

    speed: Fraction
    fastest: Fraction
    acceleration: Fraction
    near_degrees: Fraction | None
    near_millimetres: Fraction | None
    doc: str


@dataclass(frozen=True, slots=True)
class Encoders:
    """How encoders count: ticks per turn, readings, and the direction in which each one counts."""

    ticks: int
    zero: int
    highest: int
    signs: tuple[int, ...]
    doc: str


@dataclass(frozen=True, slots=True)
class Gripper:
    """A gripper: percent of its stroke a second for each percent of speed; encoder readings."""

    speed: Fraction
    closed: int
    open: int
    doc: str


@dataclass(frozen=True, slots=True)
class Servos:
    """What servos report: registers by address."""

    registers: tuple[tuple[int, int], ...]
    doc: str


@dataclass(frozen=True, slots=True)
class ErrorCodes:
    """The error codes that the arm reports when it rejects a motion."""

    joint_limits: tuple[int, ...]
    no_solution: int
    no_straight_line: int
    stopped: int
    no_power: int
    doc: str


Part = Geometry | Motion | Encoders | Gripper | Servos | ErrorCodes


@dataclass(frozen=True, slots=True)
class Robot:
    """The parts that an edition states; those that it does not state are None or empty."""

    geometry: Geometry | None = None
    motion: Motion | None = None
    encoders: Encoders | None = None
    gripper: Gripper | None = None
    servos: Servos | None = None
    error_codes: ErrorCodes | None = None
    joint_limits: tuple[tuple[Fraction, Fraction], ...] = ()
    start_angles: tuple[Fraction, ...] = ()
    # Why the geometry is not known, where it is not.
    geometry_unknown: str = ""
