"""Move an arm along the trajectories that are published on a topic."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from typing import Any

from cobotwire.adapters.ros2.dds import Reader
from cobotwire.adapters.ros2.diagnostics import ERROR, OK, WARN, Diagnostics
from cobotwire.capture.export.ros_messages import unit_in_ros
from cobotwire.client.dead_man import Silence
from cobotwire.protocol.errors import CobotwireError, UsageError
from cobotwire.protocol.table import Number
from cobotwire.session.paths import Waypoint

PERIOD_SECONDS = 0.02
# More would block the program for too long, because it plans the whole motion at once.
MOST_POINTS, LONGEST_SECONDS = 1000, 600


def waypoints_of(message: Any, joints: Sequence[Number]) -> list[Waypoint]:
    """Return the points of a JointTrajectory in the units of the edition.

    Its velocities, accelerations and efforts are not used. ``follow`` checks numbers and times.

    Raises:
        UsageError: the message is damaged (None), too long, or begins in the future; or it does not
        name each joint of the arm once.
    """
    if message is None:
        raise UsageError("trajectory", message="the message is damaged")
    names, points = message.joint_names, message.points
    expected = [joint.name for joint in joints]
    if points and (len(names) > len(joints) or sorted(names) != sorted(expected)):
        allowed = f"{' '.join(expected)}, each once, in any order"
        raise UsageError("joint_names", " ".join(names), allowed)
    if len(points) > MOST_POINTS:
        raise UsageError("len(points)", len(points), f"up to {MOST_POINTS}")
    if (start := _seconds(message.header.stamp)) > time.time():
        raise UsageError("header.stamp", start, "0, or no later than now")
    found = []
    for number, point in enumerate(points):
        if len(point.positions) != len(names):
            allowed = f"{len(names)} positions"
            raise UsageError(f"points[{number}].positions", tuple(point.positions), allowed)
        if (seconds := _seconds(point.time_from_start)) > LONGEST_SECONDS:
            raise UsageError(f"points[{number}].time", seconds, f"up to {LONGEST_SECONDS} s")
        by_name = dict(zip(names, point.positions))
        found.append(Waypoint([by_name[each.name] / unit_in_ros(each) for each in joints], seconds))
    return found


class Motion:
    """Follows the newest trajectory; stops the arm if its sender does not publish any longer."""

    def __init__(
        self,
        arm: Any,
        reader: Reader,
        diagnostics: Diagnostics,
        joints: Sequence[Number],
        silence: float,
        speed: int,
    ) -> None:
        """Let no joint exceed ``speed`` percent of its highest speed.

        Raises:
            UsageError: the edition has no targets for its joints, or no stop.
        """
        for role in ("joint targets", "stop"):
            arm.table.in_role(role)
        self._arm, self._reader, self._joints, self._speed = arm, reader, joints, speed
        self._silence, self._diagnostics = Silence(silence), diagnostics
        self._following: asyncio.Task[None] | None = None
        self._sender = 0

    async def run(self) -> None:
        """Follow the received trajectories until this task is cancelled."""
        try:
            while True:
                for message, sender in self._reader.take():
                    await self._stop("a newer trajectory was received")
                    self._sender = sender
                    self._silence.alive(time.monotonic())
                    self._following = asyncio.create_task(self._follow(message))
                if self._reader.publishes(self._sender):
                    self._silence.alive(time.monotonic())
                elif self._silence.left(time.monotonic()) <= 0:
                    await self._stop("its sender is gone")
                await asyncio.sleep(PERIOD_SECONDS)
        finally:
            await self._stop("the program ends")

    async def _stop(self, why: str) -> None:
        """End the motion under way, if any: follow() stops the arm when it is cancelled."""
        following, self._following = self._following, None
        if following is not None and not following.done():
            following.cancel()
            await asyncio.wait([following])
            self._diagnostics.note("motion", WARN, f"stopped: {why}")

    async def _follow(self, message: Any) -> None:
        note = self._diagnostics.note
        try:
            waypoints = waypoints_of(message, self._joints)
            if not waypoints:
                return
            if found := await self._diagnostics.problems():
                raise UsageError("arm", message=found)
            note("motion", OK, f"follows {len(waypoints)} points")
            report = await self._arm.follow(waypoints, speed=self._speed)
            note("motion", OK, f"arrived: {report}")
        except UsageError as error:
            note("motion", ERROR, f"refused: {error}")
        except CobotwireError as error:
            note("motion", ERROR, f"failed: {error}")


def _seconds(stamp: Any) -> float:
    return float(stamp.sec + stamp.nanosec / 1_000_000_000)
