"""Move the arm, and wait until it has arrived."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any

from cobotwire.client import events
from cobotwire.client.aio_following import AsyncFollowingClient
from cobotwire.client.opening import check_seconds
from cobotwire.protocol import roles
from cobotwire.protocol.errors import MotionTimeout, ProtocolError, ReplyTimeout
from cobotwire.protocol.messages import Request
from cobotwire.session import EncodedRequest, motion

# The default timeout of a motion.
MOTION_SECONDS = 30.0
# The default speeds, in percent of the highest.
HOME_SPEED, GRIPPER_SPEED = 10, 50


class AsyncMovingClient(AsyncFollowingClient):
    """Moves the arm and waits until it has arrived, by commands that have roles in the edition.

    A call that fails or is cancelled sends ``stop`` before its error is raised, unless the client
    was opened with ``on_error="leave"``. This is not an emergency stop: a frame can be lost.
    """

    async def move_angles(
        self,
        angles: Sequence[float],
        speed: int,
        *,
        wait: bool = True,
        timeout: float = MOTION_SECONDS,
    ) -> None:
        """Move all joints to angles, and wait until they have arrived.

        Args:
            angles: the target, in degrees, base first.
            speed: percent of the highest speed.
            wait: False: return when the request is sent.
            timeout: seconds to wait at most.

        Raises:
            UsageError: an argument is not allowed; nothing was sent.
            LinkError: the transport is gone.
            MotionTimeout: the arm does not arrive in time, or stands still short of the target.
        """
        command = self.table.in_role("joint targets")
        await self._move(
            roles.targets_request(command, angles, speed), angles, roles.ANGLES, wait, timeout
        )

    async def move_coords(
        self,
        coords: Sequence[float],
        speed: int,
        mode: int | None = None,
        *,
        wait: bool = True,
        timeout: float = MOTION_SECONDS,
    ) -> None:
        """Move the end of the arm to coordinates, and wait until it has arrived.

        Args:
            coords: the target: x, y, z in millimetres, rx, ry, rz in degrees.
            speed: percent of the highest speed.
            mode: the path, as the edition's ``send_coords`` takes it; some editions need none.
            wait: False: return when the request is sent.
            timeout: seconds to wait at most.

        Raises:
            UsageError: an argument is not allowed; nothing was sent.
            LinkError: the transport is gone.
            MotionTimeout: the arm does not arrive in time, or stands still short of the target.
        """
        command = self.table.in_role("coordinate targets")
        others = (speed,) if mode is None else (speed, mode)
        await self._move(
            roles.targets_request(command, coords, *others), coords, roles.COORDS, wait, timeout
        )

    async def wait_until_reached(
        self, target: Sequence[float], kind: int = 0, *, timeout: float = MOTION_SECONDS
    ) -> None:
        """Wait until the arm is at a target to which it was sent.

        The client queries whether the arm has arrived. If the edition has no query for that, the
        arm counts as arrived once it is within 0.5 degrees and 5 millimetres of the target.

        Args:
            target: angles in degrees, or coordinates in millimetres and degrees.
            kind: what the target is: a member of the edition's ``TargetKind``; 0 for angles and 1
                for coordinates if the edition does not number them.
            timeout: seconds to wait at most.

        Raises:
            UsageError: an argument is not allowed; nothing was sent.
            LinkError: the transport is gone.
            MotionTimeout: the arm does not arrive in time, or stands still short of the target.
        """
        check_seconds("timeout", timeout)
        goal = motion.goal_of(self.table, target, kind)
        with self._end_signs() as signs:
            try:
                await self._wait(goal, timeout, signs)
            except BaseException as error:
                await self._stop_for(error)
                raise

    async def go_home(
        self, speed: int = HOME_SPEED, *, wait: bool = True, timeout: float = MOTION_SECONDS
    ) -> None:
        """Move all joints to 0 degrees, and wait until they have arrived.

        Args:
            speed: percent of the highest speed.
            wait: False: return when the request is sent.
            timeout: seconds to wait at most.

        Raises:
            UsageError: an argument is not allowed; nothing was sent.
            LinkError: the transport is gone.
            MotionTimeout: as in ``move_angles``.
        """
        await self.move_angles([0.0] * self.table.joints, speed, wait=wait, timeout=timeout)

    async def open_gripper(self, speed: int = GRIPPER_SPEED) -> None:
        """Open the gripper, and return when the request is sent. It drops what it holds.

        Args:
            speed: percent of the highest speed.

        Raises:
            UsageError: the speed is not allowed, or the edition has no such command.
            LinkError: the transport is gone.
        """
        await self._send(roles.gripper_request(self.table, "OPEN", speed))

    async def close_gripper(self, speed: int = GRIPPER_SPEED) -> None:
        """Close the gripper, and return when the request is sent. It can pinch.

        Args:
            speed: percent of the highest speed.

        Raises:
            UsageError: the speed is not allowed, or the edition has no such command.
            LinkError: the transport is gone.
        """
        await self._send(roles.gripper_request(self.table, "CLOSE", speed))

    async def _move(
        self,
        request: Request[Any],
        target: Sequence[float],
        label: str,
        wait: bool,
        timeout: float,
    ) -> None:
        check_seconds("timeout", timeout)
        # Encoded first, so that a bad target is reported as an argument of the command.
        encoded = await self._encoded(request)
        goal = (
            motion.goal_of(self.table, target, roles.kinds_of(self.table)[label]) if wait else None
        )
        with self._end_signs() as signs:
            try:
                await self._send_motion(encoded, wait and signs.queue is not None)
                if goal is not None:
                    await self._wait(goal, timeout, signs)
            except BaseException as error:
                await self._stop_for(error)
                raise

    def _end_signs(self) -> AbstractContextManager[events.EndSigns]:
        """Return a context that collects messages that can mean the end of a motion."""
        return events.end_signs(self.table, self._address, self._connection.listeners.add)

    async def _send_motion(self, request: EncodedRequest, in_stages: bool) -> None:
        """Send a motion; in an edition with two stages the arm accepts or refuses it first."""
        within = motion.ack_seconds(request) if in_stages else None
        if within is None:
            await self._connection.send(request, None)
            return
        # The acceptance may be lost; queries will show whether the arm moves.
        try:
            await self._connection.send(request, within)
        except ReplyTimeout:
            return

    async def _wait(self, goal: motion.Goal, timeout: float, signs: events.EndSigns) -> None:
        steps = motion.until_reached(self.table, goal, timeout, self._connection.now())
        step = next(steps)
        try:
            while True:
                outcome = await self._take(step, signs)
                step = steps.send(outcome)
        except StopIteration:
            return
        except MotionTimeout as error:
            if error.stopped:
                # This arm was stopped for the error. Other arms in the same block still need a
                # stop.
                self._stopped_for = error
            raise

    async def _take(self, step: motion.Step, signs: events.EndSigns) -> motion.Outcome:
        now, result = self._connection.now, None
        if isinstance(step, motion.Listen):
            wait = max(0.0, step.until - now())
            await self._connection.listen(wait, lambda: signs.received)
            result = signs.next()
        elif isinstance(step, motion.Stop):
            result = await self._stop_for(TimeoutError())
        else:
            try:
                result = await self._call(step.request, step.longest)
            except ReplyTimeout:
                pass
            except ProtocolError:
                if not step.optional:
                    raise
            # The reply says more than an acknowledgement that came before it.
            signs.acked = signs.acked and result is None
        return motion.Outcome(now(), result)
