"""Moves the arm to poses inside the workspace, and waits until it is at rest."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.read_back import setter_of
from cobotwire.conformance.workspace import Range
from cobotwire.protocol.messages import Request
from cobotwire.protocol.roles import row_index, targets_request
from cobotwire.protocol.table import Command, Role, Table

Pose = tuple[float, ...]
# Shares of each joint's range in the workspace: no two joints are alike, and none is at zero. The
# second is near the first, because most of the time of a run is spent on the way. In the last three
# poses the arm is bent, so that its end can move a little way nearly anywhere.
POSES = (
    (0.71, 0.37, 0.62, 0.29, 0.83, 0.17),
    (0.59, 0.54, 0.47, 0.42, 0.68, 0.33),
    (0.58, 0.22, 0.12, 0.57, 0.62, 0.44),
    (0.44, 0.30, 0.05, 0.78, 0.36, 0.66),
    (0.58, 0.06, 0.72, 0.94, 0.83, 0.52),
)
# A joint rests on an encoder tick, and its angle is truncated to hundredths. Where the edition does
# not state the encoders, this much is allowed for a tick, in degrees.
USUAL_TICK, TRUNCATED = 0.1, 0.01
# How often a moving arm is polled, and how long one motion may last, in seconds.
POLL = 0.05
LONGEST = 30.0


def angle_tolerance(table: Table) -> float:
    """Return how far from its target the angle of a joint at rest may be, in degrees."""
    encoders = table.robot.encoders
    return (encoders.degrees if encoders else USUAL_TICK) + TRUNCATED


class Mover:
    """Moves the arm by the commands that the edition names for each role."""

    def __init__(self, device: Device) -> None:
        """Prepare to move.

        Raises:
            NotSupported: the edition lacks a role, or the arm may not be given power.
        """
        self.device = device
        self.targets = self._in_role("joint targets")
        self.joints = self._in_role("joints")
        self.speed = self.device.permissions.max_speed or 1
        self.tolerance = angle_tolerance(self.device.table)
        # The index of the pose that the arm is near; None if no test case has set it.
        self.near: int | None = None
        give_power(self.device)
        self._come_back()

    @property
    def poses(self) -> list[int]:
        """The indices of the poses. Those from which the arm has moved come first, latest first."""
        return list(dict.fromkeys([*self.device.noticed.poses, *range(len(POSES))]))

    def go_near(self, which: int) -> None:
        """Go to a pose, unless the arm has only made small motions since it was there."""
        if self.near != which:
            self.go(self.pose(which))
        self.near = which

    @property
    def ranges(self) -> list[Range]:
        """The workspace, as far as the edition allows targets there; degrees for each joint."""
        row = self.targets.request[0].fields[row_index(self.targets.request[0])]
        legal = ((n.physical(n.minimum), n.physical(n.maximum)) for n in row.cases[0].numbers)
        found = []
        for (low, high), (least, most) in zip(self.device.permissions.workspace, legal):
            near = max(low, least), min(high, most)
            found.append(near if near[0] < near[1] else (least, most))
        return found

    def pose(self, which: int) -> Pose:
        """Return one of the poses, in degrees."""
        ranges = self.ranges
        shares = (POSES[which][at % len(POSES[which])] for at in range(len(ranges)))
        return tuple(
            round(low + share * (high - low), 2) for share, (low, high) in zip(shares, ranges)
        )

    def go(self, pose: Pose) -> None:
        """Move to a pose, and wait until the arm is at rest."""
        self.device.request(self.to(pose))
        self.wait()

    def to(self, pose: Pose, speed: int | None = None) -> Request[Any]:
        """Return the request that sends the arm to a pose; by default at the run's speed."""
        return targets_request(self.targets, pose, speed or self.speed)

    def wait(self) -> None:
        """Wait until the arm reports that it is at rest."""
        moving = self.device.command("moving")
        if moving is not None:
            self.rest(POLL)
            reading = partial(self.device.is_set, moving.request_type())
            self.device.poll(reading, lambda moves: moves is False, LONGEST, POLL)

    def settle(self, read: Callable[[], object]) -> None:
        """Wait until the arm is at rest, and a reading stays the same: a gripper may still move."""
        self.wait()
        seen = [read()]
        self.rest(POLL)

        def stays(reading: object) -> bool:
            seen.append(reading)
            return seen[-3:] == [reading] * 3

        self.device.poll(read, stays, LONGEST, POLL)

    def rest(self, seconds: float) -> None:
        """Let time pass without a request."""
        self.device.rest(seconds)

    def place(self) -> Pose | None:
        """Return the joints' angles, in degrees; None if no valid reply comes."""
        reply = self.device.read(self.joints.request_type())
        return None if reply is None else tuple(reply.result)

    def angles(self) -> Pose:
        """Return the joints' angles, in degrees.

        Raises:
            NotSupported: no valid reply comes.
        """
        return tuple(self.device.require(self.joints.request_type()).result)

    def differences(self, wanted: Pose) -> list[str]:
        """Describe the joints that are not where they should be, or the illegal values reported.

        Raises:
            NotSupported: no reply came.
        """
        response = self.device.request(self.joints.request_type())
        if response.valid is None and response.replies:
            return [f"{self.joints.name}: expected legal values; {response.replies[0].error}"]
        message = response.valid and response.valid.message
        pose = tuple(message.result) if message else self.angles()
        wrong = off_by(pose, wanted, self.tolerance)
        again = self.angles() if wrong else pose
        if wrong and not off_by(again, wanted, self.tolerance):
            return [
                f"the reply of {self.joints.name} is stale: at rest it reported first {pose}, and "
                f"then {again}, the target"
            ]
        return wrong

    def _in_role(self, role: Role) -> Command:
        command = self.device.command(role)
        if command is None:
            raise NotSupported(f"the edition has no command in the role {role}")
        return command

    def _come_back(self) -> None:
        """Plan the return to the present pose at the end, if that is inside the workspace."""
        ranges = self.device.permissions.workspace
        pose = self.angles()
        inside = all(low <= angle <= high for angle, (low, high) in zip(pose, ranges))
        if inside and "pose" not in self.device.restore_at_end:
            self.device.restore_at_end["pose"] = lambda: self.go(pose)


def off_by(pose: Pose, wanted: Pose, tolerance: float, why: str = "sent to") -> list[str]:
    """Describe the joints that are further from where they should be than the tolerance."""
    return [
        f"joint {at}: {why} {want} degree, is at {have}"
        for at, (have, want) in enumerate(zip(pose, wanted), 1)
        if abs(have - want) > tolerance
    ]


def give_power(device: Device) -> None:
    """Switch the arm on if it is off; the end of the run switches it off again.

    Raises:
        NotSupported: it is off, and the run may not switch it on.
    """
    powered = device.command("powered")
    if powered is None or device.is_set(powered.request_type()):
        return
    on, off = (setter_of(device.table, powered, value) for value in (1, 0))
    if on is None or "power" not in device.permissions.classes:
        raise NotSupported("the arm has no power, and the run may not switch it on")
    if off is not None:
        device.restore_at_end["power"] = partial(device.request, off.request_type())
    device.request(on.request_type())
