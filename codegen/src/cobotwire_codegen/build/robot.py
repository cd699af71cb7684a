"""Builds what an edition states about its robot."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import partial
from typing import TypeVar

from cobotwire_codegen import language
from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.language.records import Key
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import (
    Encoders,
    ErrorCodes,
    Geometry,
    Gripper,
    Link,
    Motion,
    Robot,
    Servos,
)
from cobotwire_codegen.reader import Reader

T = TypeVar("T")


def build_robot(parts: Parts, problems: list[Problem]) -> Robot:
    """Return what an edition and its bases state about their robot."""
    build = partial(_part, parts, problems)
    robot = Robot(
        build("geometry", _geometry),
        build("motion", _motion),
        build("encoders", _encoders),
        build("gripper", _gripper),
        build("servos", _servos),
        build("error_codes", _error_codes),
        build("joint_limits", _joint_limits) or (),
        build("start_angles", _start_angles) or (),
        "" if "geometry" in parts.robot else parts.geometry_unknown,
    )
    for number, (angle, pair) in enumerate(zip(robot.start_angles, robot.joint_limits), 1):
        if not pair[0] <= angle <= pair[1]:
            low, high = (f"{float(end):g}" for end in pair)
            message = f"joint {number} starts at {float(angle):g}; its limits are {low}..{high}"
            problems.append(Problem(parts.robot["start_angles"].place, "bad-start-value", message))
    return robot


def _part(
    parts: Parts,
    problems: list[Problem],
    name: str,
    build: Callable[[Node, int, list[Problem]], T],
) -> T | None:
    """Return a part of the robot; None if neither the edition nor its base states it."""
    node = parts.robot.get(name)
    return None if node is None else build(node, parts.joints or 0, problems)


def _geometry(node: Node, joints: int, problems: list[Problem]) -> Geometry:
    spec = language.Geometry
    reader = Reader(node, spec, "the geometry", problems)
    links: list[Link] = []
    for row in reader.get(spec.links):
        links.append(_link(row, _after(links), problems))
    turning = {joint for link in links for joint, share in link.turned_by if share}
    if turning != set(range(1, joints + 1)):
        message = (
            f"each of the {joints} joints, and no other joint, must turn a link of the geometry"
        )
        reader.problem("bad-number", message)
    return Geometry(tuple(links), reader.get(spec.doc))


def _after(links: Iterable[Link]) -> int:
    """Return the joint after the highest one that turns a link."""
    return max((joint for link in links for joint, _ in link.turned_by), default=0) + 1


def _link(node: Node, next_joint: int, problems: list[Problem]) -> Link:
    spec = language.Link
    reader = Reader(node, spec, "a link of the geometry", problems)
    turned_by: tuple[tuple[int, Fraction], ...] = ((next_joint, Fraction(1)),)
    if reader.node(spec.turned_by) is not None:
        shares = reader.get(spec.turned_by)
        subject = f"a share in turned_by of {reader.what}"
        turned_by = tuple(
            (int(joint), language.Link.a.shape.read(share, subject, reader.problem))
            for joint, _, share in shares
            if joint.isdigit()
        )
    offset, alpha, a, d = (reader.get(key) for key in (spec.offset, spec.alpha, spec.a, spec.d))
    return Link(offset, alpha, a, d, turned_by)


def _motion(node: Node, joints: int, problems: list[Problem]) -> Motion:
    spec = language.Motion
    reader = Reader(node, spec, "the motion", problems)
    speed, fastest, acceleration = map(reader.get, (spec.speed, spec.fastest, spec.acceleration))
    if min(speed, fastest, acceleration) <= 0:
        reader.problem("bad-number", "the numbers of the motion must be above 0")
    degrees, millimetres = (
        _stated(reader, key) for key in (spec.near_degrees, spec.near_millimetres)
    )
    return Motion(speed, fastest, acceleration, degrees, millimetres, reader.get(spec.doc))


def _encoders(node: Node, joints: int, problems: list[Problem]) -> Encoders:
    spec = language.Encoders
    reader = Reader(node, spec, "the encoders", problems)
    signs = reader.get(spec.signs)
    if reader.node(spec.signs) is not None and (len(signs) != joints or set(signs) - {1, -1}):
        message = f"the encoders must have a sign 1 or -1 for each of {joints} joints"
        reader.problem("bad-number", message, reader.place_of(spec.signs))
    zero, highest = reader.get(spec.zero), reader.get(spec.highest)
    if zero > highest:
        message = f"zero of {reader.what} is {zero}; allowed: 0..{highest}"
        reader.problem("bad-number", message, reader.place_of(spec.zero))
    return Encoders(reader.get(spec.ticks), zero, highest, signs, reader.get(spec.doc))


def _gripper(node: Node, joints: int, problems: list[Problem]) -> Gripper:
    spec = language.Gripper
    reader = Reader(node, spec, "the gripper", problems)
    closed, open_ = reader.get(spec.closed), reader.get(spec.open_)
    if closed == open_:
        reader.problem("bad-number", "the gripper must have different readings closed and open")
    return Gripper(reader.get(spec.speed), closed, open_, reader.get(spec.doc))


def _servos(node: Node, joints: int, problems: list[Problem]) -> Servos:
    spec = language.Servos
    reader = Reader(node, spec, "the servos", problems)
    shape = language.Encoders.zero.shape
    registers = tuple(
        (int(name), shape.read(value, f"register {name} of {reader.what}", reader.problem))
        for name, _, value in reader.get(spec.registers)
        if name.isdigit()
    )
    return Servos(registers, reader.get(spec.doc))


def _error_codes(node: Node, joints: int, problems: list[Problem]) -> ErrorCodes:
    spec = language.ErrorCodes
    reader = Reader(node, spec, "the error codes", problems)
    limits = reader.get(spec.joint_limits)
    if len(limits) != joints or min(limits, default=1) < 1:
        message = f"joint_limits must list one error code above 0 for each of {joints} joints"
        reader.problem("bad-number", message, reader.place_of(spec.joint_limits))
    return ErrorCodes(
        limits,
        reader.get(spec.no_solution),
        reader.get(spec.no_straight_line),
        reader.get(spec.stopped),
        reader.get(spec.no_power),
        reader.get(spec.doc),
    )


def _joint_limits(
    node: Node, joints: int, problems: list[Problem]
) -> tuple[tuple[Fraction, Fraction], ...]:
    shape, note = language.WholeEdition.joint_limits.shape, partial(_note, problems)
    pairs = shape.read(node, "joint_limits", note)
    _one_each("joint_limits", pairs, joints, node, problems)
    return pairs


def _start_angles(node: Node, joints: int, problems: list[Problem]) -> tuple[Fraction, ...]:
    shape, note = language.WholeEdition.start_angles.shape, partial(_note, problems)
    angles = shape.read(node, "start_angles", note)
    _one_each("start_angles", angles, joints, node, problems)
    return angles


def _stated(reader: Reader, key: Key[Fraction]) -> Fraction | None:
    return None if reader.node(key) is None else reader.get(key)


def _one_each(
    name: str, found: Sequence[object], joints: int, node: Node, problems: list[Problem]
) -> None:
    if len(found) != joints:
        message = f"{name} has {len(found)} entries for {joints} joints"
        problems.append(Problem(node.place, "bad-number", message))


def _note(problems: list[Problem], code: str, message: str, place: Place) -> None:
    problems.append(Problem(place, code, message))
