"""State the ROS 2 messages that we write and read, and write them as CDR.

MCAP files hold these bytes; ``cobotwire ros2`` makes its DDS types from the same definitions. They
are those of the packages ``common_interfaces``, ``geometry2`` and ``rcl_interfaces``, without
comments and constants. https://design.ros2.org/articles/mapping_dds_types.html says how DDS names
them; the bytes are version 1 of CDR, in which a number starts at a multiple of its size.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple

from cobotwire.kinematics import Pose
from cobotwire.kinematics.straight import quaternion
from cobotwire.protocol.table import Number

Message = dict[str, Any]

JOINT_STATE = "sensor_msgs/msg/JointState"
TF_MESSAGE = "tf2_msgs/msg/TFMessage"
DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"
JOINT_TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
# The frames of poses: the foot of the arm, and the end of the arm.
BASE, END = "base", "end"

_TIME = "int32 sec\nuint32 nanosec\n"
_DEFINITIONS = {
    "builtin_interfaces/msg/Duration": _TIME,
    "builtin_interfaces/msg/Time": _TIME,
    "std_msgs/msg/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "geometry_msgs/msg/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/msg/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
    "geometry_msgs/msg/Transform": (
        "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"
    ),
    "geometry_msgs/msg/TransformStamped": (
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"
    ),
    "diagnostic_msgs/msg/KeyValue": "string key\nstring value\n",
    "diagnostic_msgs/msg/DiagnosticStatus": (
        "byte level\nstring name\nstring message\nstring hardware_id\n"
        "diagnostic_msgs/KeyValue[] values\n"
    ),
    "trajectory_msgs/msg/JointTrajectoryPoint": (
        "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n"
        "builtin_interfaces/Duration time_from_start\n"
    ),
    JOINT_STATE: (
        "std_msgs/Header header\nstring[] name\n"
        "float64[] position\nfloat64[] velocity\nfloat64[] effort\n"
    ),
    TF_MESSAGE: "geometry_msgs/TransformStamped[] transforms\n",
    DIAGNOSTICS: "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n",
    JOINT_TRAJECTORY: (
        "std_msgs/Header header\nstring[] joint_names\n"
        "trajectory_msgs/JointTrajectoryPoint[] points\n"
    ),
}
_SCALARS = {"byte": "B", "int32": "<i", "uint32": "<I", "float64": "<d"}
# Version 1 of CDR, little endian, without options.
_ENCAPSULATION = b"\x00\x01\x00\x00"
_LATEST = 2**31 - 1
_RADIANS_OR_METRES = {"degree": math.radians(1), "millimetre": 1e-3}


class Field(NamedTuple):
    """A field of a message: the name of a scalar or of a message, or a sequence of that."""

    kind: str
    name: str
    many: bool


@cache
def fields_of(kind: str) -> tuple[Field, ...]:
    """Return the fields of a message, such as ``sensor_msgs/msg/JointState``."""
    lines = (line.split() for line in _DEFINITIONS[kind].splitlines())
    return tuple(
        Field(_full(word.removesuffix("[]")), name, word.endswith("[]")) for word, name in lines
    )


@cache
def schema_text(kind: str) -> str:
    """Return a definition and the definitions that it needs, as text in MCAP's ``ros2msg``."""
    needed = list(dict.fromkeys(_needed(kind)))
    parts = [f"MSG: {each.replace('/msg/', '/')}\n{_DEFINITIONS[each]}" for each in needed]
    return f"{'=' * 80}\n".join([_DEFINITIONS[kind], *parts])


def serialised(kind: str, message: Message) -> bytes:
    """Return a message as CDR."""
    out = bytearray()
    _write(out, kind, message)
    return _ENCAPSULATION + bytes(out)


def header(time_ns: int, frame: str = "") -> Message:
    """Return the header of a message; a time after the last of ROS (2038) becomes the last."""
    sec, nanosec = divmod(time_ns, 1_000_000_000)
    return {"stamp": {"sec": min(sec, _LATEST), "nanosec": nanosec}, "frame_id": frame}


def unit_in_ros(number: Number) -> float:
    """Return the factor from the unit of a joint to that of ROS: radians or metres."""
    return _RADIANS_OR_METRES.get(number.unit, 1.0)


def joint_state(time_ns: int, joints: Sequence[Number], values: Sequence[float]) -> Message:
    """Return the positions of joints; ``values`` have the units of the edition."""
    names = [joint.name for joint in joints]
    positions = [value * unit_in_ros(joint) for joint, value in zip(joints, values)]
    state = {"header": header(time_ns), "name": names, "position": positions}
    return {**state, "velocity": [], "effort": []}


def transform(time_ns: int, pose: Pose, parent: str = BASE, child: str = END) -> Message:
    """Return where the frame ``child`` is in the frame ``parent``."""
    w, *turn = quaternion(pose)
    moved = {
        "translation": {axis: part / 1000 for axis, part in zip("xyz", pose.origin)},
        "rotation": dict(zip("xyzw", (*turn, w))),
    }
    stamped = {"header": header(time_ns, parent), "child_frame_id": child, "transform": moved}
    return {"transforms": [stamped]}


def _full(kind: str) -> str:
    return kind.replace("/", "/msg/")


def _needed(kind: str) -> Iterator[str]:
    for field in fields_of(kind):
        if field.kind in _DEFINITIONS:
            yield field.kind
            yield from _needed(field.kind)


def _write(out: bytearray, kind: str, value: Any) -> None:
    if kind == "string":
        data = value.encode() + b"\0"
        _write(out, "uint32", len(data))
        out += data
    elif kind in _SCALARS:
        packed = struct.pack(_SCALARS[kind], value)
        out += bytes(-len(out) % len(packed)) + packed
    else:
        for field in fields_of(kind):
            parts = value[field.name] if field.many else [value[field.name]]
            if field.many:
                _write(out, "uint32", len(parts))
            for part in parts:
                _write(out, field.kind, part)
