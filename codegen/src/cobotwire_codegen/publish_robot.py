"""Publish what an edition states about its robot, as a part of ``edition.json``."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from cobotwire_codegen.model import Edition, Geometry, Link, Servos
from cobotwire_codegen.publish_sections import exact_number

Record = dict[str, Any]


def robot_parts(edition: Edition) -> Record:
    """Return the parts of the robot; what the edition does not state is None or empty."""
    robot = edition.robot
    return {
        "geometry": robot.geometry and _geometry(robot.geometry),
        "geometry_unknown": robot.geometry_unknown,
        **{
            name: _numbers(getattr(robot, name))
            for name in ("motion", "encoders", "gripper", "error_codes")
        },
        "servos": robot.servos and _servos(robot.servos),
        "joint_limits": [
            {"low": exact_number(low), "high": exact_number(high)}
            for low, high in robot.joint_limits
        ],
        "start_angles": [exact_number(angle) for angle in robot.start_angles],
    }


def _geometry(geometry: Geometry) -> Record:
    return {
        "links": [_link(link, coupled=is_coupled(geometry)) for link in geometry.links],
        "doc": geometry.doc,
    }


def is_coupled(geometry: Geometry) -> bool:
    """Return whether any link is turned by other joints than the one with its own number."""
    usual = [((number, Fraction(1)),) for number, _ in enumerate(geometry.links, 1)]
    return [link.turned_by for link in geometry.links] != usual


def _link(link: Link, *, coupled: bool) -> Record:
    record: Record = {
        name: exact_number(getattr(link, name)) for name in ("offset", "alpha", "a", "d")
    }
    if coupled:
        record["turned_by"] = [
            {"joint": joint, "share": exact_number(share)} for joint, share in link.turned_by
        ]
    return record


def _servos(servos: Servos) -> Record:
    registers = [{"address": address, "initial": value} for address, value in servos.registers]
    return {"registers": registers, "doc": servos.doc}


def _numbers(part: Any) -> Record | None:
    """Return the fields of a part that are stated."""
    if part is None:
        return None
    fields = ((name, getattr(part, name)) for name in part.__slots__)
    return {name: _plain(value) for name, value in fields if value not in (None, ())}


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return exact_number(value) if isinstance(value, Fraction) else value
