"""Publish what an arm reports on the topics of ROS 2, and move it along trajectories."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from functools import partial

from cobotwire.adapters.ros2.dds import Participant
from cobotwire.adapters.ros2.diagnostics import ERROR, Diagnostics
from cobotwire.adapters.ros2.motion import Motion
from cobotwire.capture.export import ros_messages as ros
from cobotwire.client.aio import AsyncClient
from cobotwire.kinematics import Pose, flange, geometry_of
from cobotwire.kinematics.coordinates import indices_of, pose_with
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.table import Command, Number, Role, Table

DIAGNOSTICS_SECONDS = 1.0
FASTEST = 1000.0
# How many transforms ROS 2 keeps for a slow reader.
TRANSFORMS = 100


class Bridge:
    """Samples an arm; publishes its joints, the pose of its end, and its state.

    Attributes:
        topics: the topics that it publishes, then those that it reads.
    """

    def __init__(
        self,
        arm: AsyncClient,
        participant: Participant,
        url: str,
        rate: float,
        silence: float | None = None,
        speed: int = 100,
    ) -> None:
        """Publish at most ``rate`` samples a second; ``url`` names the port in the diagnostics.

        A motion is stopped if its sender is gone for ``silence`` seconds; None: the arm takes no
        motions. No joint exceeds ``speed`` percent of its highest speed.

        Raises:
            UsageError: the rate is not allowed, or the edition lacks what is needed.
        """
        if not 0 < rate <= FASTEST:
            raise UsageError("rate", rate, f"above 0, up to {FASTEST:g}")
        self._period, self._joints = 1 / rate, arm.table.in_role("joints")
        # The participant leaves the domain when its last reference is gone.
        self._participant = participant
        self._end, self._numbers = _end_of(arm.table, self._joints), numbers_of(arm.table, "joints")
        self._state = participant.publisher("joint_states", ros.JOINT_STATE)
        self._transform = participant.publisher("tf", ros.TF_MESSAGE, TRANSFORMS)
        report = participant.publisher("diagnostics", ros.DIAGNOSTICS)
        self._diagnostics = Diagnostics(arm, url, report)
        self.topics = ["/joint_states", *["/tf"] * (self._end is not None), "/diagnostics"]
        self._motion: Motion | None = None
        if silence is not None:
            reader = participant.reader("joint_trajectory", ros.JOINT_TRAJECTORY)
            self._motion = Motion(arm, reader, self._diagnostics, self._numbers, silence, speed)
            self.topics.append("/joint_trajectory")

    async def run(self) -> None:
        """Publish samples until this task is cancelled.

        Raises:
            LinkError: the port disappeared; the diagnostics report it.
        """
        tasks = [asyncio.create_task(self._sample())]
        if self._motion is not None:
            tasks.append(asyncio.create_task(self._motion.run()))
        try:
            ended, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in ended:
                task.result()
        except LinkError as error:
            self._diagnostics.note("line", ERROR, str(error))
            raise
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.wait(tasks)

    async def _sample(self) -> None:
        due = reported = time.monotonic()
        taken = 0
        while True:
            await self._publish()
            taken, passed = taken + 1, time.monotonic() - reported
            if passed >= DIAGNOSTICS_SECONDS:
                await self._diagnostics.report(taken / passed)
                taken, reported = 0, reported + passed
            # Missed samples are skipped: catching up would load an arm that is already too slow.
            due = max(due + self._period, time.monotonic())
            await asyncio.sleep(due - time.monotonic())

    async def _publish(self) -> None:
        angles = await self._diagnostics.query(self._joints)
        if angles is not None:
            self._state(ros.joint_state(time.time_ns(), self._numbers, angles))
        if self._end is None:
            return
        query, pose_of = self._end
        values = angles if query is self._joints else await self._diagnostics.query(query)
        if values is not None:
            self._transform(ros.transform(time.time_ns(), pose_of(values)))


def numbers_of(table: Table, role: Role) -> tuple[Number, ...]:
    """Return the numbers that the query of a role reports: one for each joint, for example."""
    return table.in_role(role).variants("reply")[0].fields[0].numbers


def _end_of(
    table: Table, joints: Command
) -> tuple[Command, Callable[[Sequence[float]], Pose]] | None:
    """Return a query, and the function that turns its result into the pose of the end of the arm.

    Coordinates from the arm respect its tool and its frame. If an edition reports none, the
    geometry gives the pose.
    """
    query, geometry = table.find_role("coordinates"), geometry_of(table)
    if query is not None:
        indices = indices_of(numbers_of(table, "coordinates"))
        return None if indices is None else (query, partial(pose_with, indices=indices, other=None))
    return None if geometry is None else (joints, partial(flange, geometry))
