"""Derive what robotics tools draw from the angles that an arm reports: its joints, its end."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from cobotwire.capture.export.formats.mcap_schemas import JOINT_STATES, POSE_IN_FRAME, Schema
from cobotwire.capture.export.plan import Editions, Message

# The last part of the topics, by the name of the schema.
TOPICS = {"foxglove.JointStates": "joint_states", "foxglove.PoseInFrame": "end"}
# The frame of reference of poses: the foot of the arm.
FRAME = "base"
_TO_METRES_AND_RADIANS = {"degree": math.radians(1), "millimetre": 1e-3}


class Motion:
    """Knows how an edition reports the angles of all joints, and the geometry of its arm."""

    def __init__(self, editions: Editions, edition: str) -> None:
        table = editions.codec(edition).table
        self._found = {
            command.name: command.variants("reply")[0].fields[0]
            for command in table.commands
            if command.role == "joints"
        }
        self._forward = editions.forward(edition)

    def derived(
        self, message: Message, fields: dict[str, Any], time_ns: int
    ) -> Iterator[tuple[Schema, Any]]:
        """Yield the joint states and the pose of a message, each with its schema."""
        if message.direction != "reply" or message.command not in self._found:
            return
        field = self._found[message.command]
        angles = fields[field.name]
        sec, nsec = divmod(time_ns, 1_000_000_000)
        timestamp = {"sec": sec, "nsec": nsec}
        joints = [
            {"name": number.name, "position": angle * _TO_METRES_AND_RADIANS.get(number.unit, 1.0)}
            for number, angle in zip(field.numbers, angles)
        ]
        yield JOINT_STATES, {"timestamp": timestamp, "joints": joints}
        if self._forward is not None:
            pose = _pose(self._forward(angles))
            yield POSE_IN_FRAME, {"timestamp": timestamp, "frame_id": FRAME, "pose": pose}


def _pose(coords: Sequence[float]) -> dict[str, dict[str, float]]:
    """Return a pose in metres, with a quaternion of R = Rz(rz) Ry(ry) Rx(rx)."""
    x, y, z, rx, ry, rz = coords
    (cr, sr), (cp, sp), (cy, sy) = [
        (math.cos(half), math.sin(half)) for half in (math.radians(a) / 2 for a in (rx, ry, rz))
    ]
    return {
        "position": {"x": x / 1000, "y": y / 1000, "z": z / 1000},
        "orientation": {
            "x": sr * cp * cy - cr * sp * sy,
            "y": cr * sp * cy + sr * cp * sy,
            "z": cr * cp * sy - sr * sp * cy,
            "w": cr * cp * cy + sr * sp * sy,
        },
    }
