"""Derive joint states and poses of the end of the arm from reported angles, for robotics tools."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from cobotwire.capture.export import ros_messages as ros
from cobotwire.capture.export.plan import Editions, Message
from cobotwire.kinematics import Pose


class Derived(NamedTuple):
    """A ROS message: the last part of its topic, its type, its content."""

    topic: str
    kind: str
    content: ros.Message


class Motion:
    """Derives motion from an edition's reports of all joints, and from its arm's geometry."""

    def __init__(self, editions: Editions, edition: str) -> None:
        table = editions.codec(edition).table
        self._found = {
            command.name: command.variants("reply")[0].fields[0]
            for command in table.commands
            if command.role == "joints"
        }
        self._forward = editions.forward(edition)

    def derived(
        self, message: Message, fields: dict[str, Any], time_ns: int, device: str
    ) -> Iterator[Derived]:
        """Yield the joint state and the pose of a message of a device."""
        if message.direction != "reply" or message.command not in self._found:
            return
        field = self._found[message.command]
        angles = fields[field.name]
        state = ros.joint_state(time_ns, field.numbers, angles)
        yield Derived("joint_states", ros.JOINT_STATE, state)
        if self._forward is not None:
            pose = Pose.of(self._forward(angles))
            moved = ros.transform(time_ns, pose, child=f"{device[1:]}/{ros.END}")
            yield Derived("tf", ros.TF_MESSAGE, moved)
