"""What an edition states about its robot for simulation: everything except its messages.

Everything that is not stated is None or empty.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from cobotwire.protocol.printable import printable

Record = dict[str, Any]
# How far a link turns for a degree of each joint that turns it; joints count from 0.
Shares = tuple[tuple[int, float], ...]


class Dimensions(NamedTuple):
    """The geometry of an arm.

    Attributes:
        links: standard Denavit-Hartenberg parameters of each link, from the base on: offset and
            alpha in degrees, a and d in millimetres; then the joints that turn the link, or None
            if that is the joint of the same number.
        unverified: the file that a user gave for it; empty: the edition states the geometry.
    """

    links: tuple[tuple[float, float, float, float, Shares | None], ...]
    unverified: str = ""


class Dynamics(NamedTuple):
    """How an arm moves.

    Attributes:
        speed: degrees a second for each percent of speed.
        fastest: the highest speed of a joint, in degrees a second.
        acceleration: the highest acceleration, in degrees per second squared.
        near_degrees: the distance at which a joint has reached its target.
        near_millimetres: the distance at which the end of the arm has reached its target.
    """

    speed: float
    fastest: float
    acceleration: float
    near_degrees: float | None = None
    near_millimetres: float | None = None


class Encoders(NamedTuple):
    """How the encoders of the joints count. Joints are counted from 0.

    Attributes:
        ticks: the ticks of a whole turn.
        zero: the reading at 0 degrees.
        highest: the highest reading; the lowest is 0.
        signs: for each joint, whether its encoder counts up (+1) or down (-1) while the angle
            grows; empty if that is not known.
    """

    ticks: int
    zero: int
    highest: int
    signs: tuple[int, ...] = ()

    @property
    def degrees(self) -> float:
        """The degrees of a tick."""
        return 360 / self.ticks

    def sign(self, joint: int) -> int:
        """Return the direction of a joint's encoder; up if it is not known."""
        return self.signs[joint] if self.signs else 1

    def on_tick(self, degrees: float) -> float:
        """Return the angle of the nearest tick."""
        return round(degrees / self.degrees) * self.degrees

    def reading(self, joint: int, degrees: float) -> int:
        """Return what the encoder of a joint reads at an angle."""
        reading = self.zero + self.sign(joint) * round(degrees / self.degrees)
        return min(max(reading, 0), self.highest)

    def angle(self, joint: int, reading: int) -> float:
        """Return the angle of a joint at which its encoder has a reading."""
        return self.sign(joint) * (reading - self.zero) * self.degrees

    def inside(self, joint: int, lowest: float, highest: float) -> tuple[float, float]:
        """Return the lowest and highest angle on a tick within limits; low > high if none is."""
        ends = self.angle(joint, 0), self.angle(joint, self.highest)
        lowest, highest = max(lowest, min(ends)), min(highest, max(ends))
        step = self.degrees
        return math.ceil(lowest / step) * step, math.floor(highest / step) * step


class Gripper(NamedTuple):
    """A gripper.

    Attributes:
        speed: percent of its travel a second, for each percent of speed.
        closed: the reading of its encoder when it is closed.
        open: the reading of its encoder when it is open.
    """

    speed: float
    closed: int
    open: int


class Servos(NamedTuple):
    """What servos report.

    Attributes:
        registers: the address and initial value of each register.
    """

    registers: tuple[tuple[int, int], ...] = ()


class ErrorCodes(NamedTuple):
    """The numbers that an arm reports when it rejects a motion.

    Attributes:
        joint_limits: for each joint, the number for a target beyond its limit.
        no_solution: no joint angles bring the end of the arm to the target.
        no_straight_line: the joints cannot follow a straight line.
        stopped: a motion was stopped before its target; 0: it has no number.
        no_power: the arm has no power, or not every joint is held; 0: it has no number.
    """

    joint_limits: tuple[int, ...]
    no_solution: int
    no_straight_line: int
    stopped: int = 0
    no_power: int = 0


class Robot(NamedTuple):
    """The robot of an edition.

    Attributes:
        geometry: its links.
        motion: how it moves.
        encoders: how its encoders count.
        gripper: its gripper.
        servos: what its servos report.
        error_codes: the numbers of rejected motions.
        joint_limits: the lowest and the highest angle of each joint.
        start_angles: the joint angles at which a simulated arm starts.
        state: what the arm keeps, by name (:func:`cobotwire.protocol.effects.states_of`).
        geometry_unknown: why the links are not known, where they are not.
    """

    geometry: Dimensions | None = None
    motion: Dynamics | None = None
    encoders: Encoders | None = None
    gripper: Gripper | None = None
    servos: Servos | None = None
    error_codes: ErrorCodes | None = None
    joint_limits: tuple[tuple[float, float], ...] = ()
    start_angles: tuple[float, ...] = ()
    state: Mapping[str, Record] = MappingProxyType({})
    geometry_unknown: str = ""

    @property
    def why_no_geometry(self) -> str:
        """Say that the geometry is not known, and why if the edition states it."""
        why = f": {self.geometry_unknown}" if self.geometry_unknown else ""
        return f"the geometry of this arm is not known{why}"

    @property
    def geometry_remark(self) -> str:
        """Say which file the geometry is from; empty if the edition states it, or none is known."""
        file = "" if self.geometry is None else printable(self.geometry.unverified)
        return file and f"the geometry is that of {file}, unverified"


UNSTATED = Robot()


def load_robot(edition: Record) -> Robot:
    """Return the robot that the record of an edition in ``edition.json`` describes."""
    get = edition.get
    motion, encoders, gripper = get("motion"), get("encoders"), get("gripper")
    servos, codes = get("servos"), get("error_codes")
    return Robot(
        _dimensions(get("geometry")),
        motion and Dynamics(**_numbers(motion)),
        encoders and Encoders(**_numbers(encoders)),
        gripper and Gripper(**_numbers(gripper)),
        servos and _servos(servos["registers"]),
        codes and ErrorCodes(**_numbers(codes)),
        tuple([(real(each["low"]), real(each["high"])) for each in get("joint_limits", ())]),
        tuple([real(angle) for angle in get("start_angles", ())]),
        get("state", UNSTATED.state),
        get("geometry_unknown", ""),
    )


def _dimensions(record: Record | None) -> Dimensions | None:
    if record is None:
        return None
    return Dimensions(tuple([_link(**link) for link in record["links"]]))


def _link(
    offset: Any, alpha: Any, a: Any, d: Any, turned_by: Any = None
) -> tuple[float, float, float, float, Shares | None]:
    shares = turned_by and tuple([(each["joint"] - 1, real(each["share"])) for each in turned_by])
    fixed: Shares | None = () if turned_by == [] else shares
    return real(offset), real(alpha), real(a), real(d), fixed


def _servos(registers: list[Record]) -> Servos:
    return Servos(tuple([(each["address"], each["initial"]) for each in registers]))


def _numbers(record: Record) -> Record:
    return {name: _number(value) for name, value in record.items() if name != "doc"}


def _number(value: Any) -> Any:
    if isinstance(value, list):
        return tuple([_number(item) for item in value])
    return real(value) if isinstance(value, str) else value


def real(number: int | str) -> float:
    """Return the nearest float to an exact number, such as ``-552/5``."""
    numerator, _, denominator = str(number).partition("/")
    return int(numerator) / int(denominator or 1)
