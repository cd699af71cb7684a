"""What the classes of the Mercury and the Pro robots share: the arm reports the end of motions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any, ClassVar

from cobotwire.protocol.errors import (
    ArmNotReady,
    MotionTimeout,
    ProtocolError,
    ReplyTimeout,
    RequestRefused,
    UsageError,
    no_power,
)
from cobotwire.pymycobot.layer.client import DONE, CompatibleClient
from cobotwire.pymycobot.layer.naming import naming
from cobotwire.pymycobot.layer.ranges import check_range
from cobotwire.pymycobot.layer.results import plain, tenths

# After this time without a report of the end of a motion, the client queries whether the arm moves.
QUERY_SECONDS = 1.0
# The report was lost if this many queries in a row find the arm at rest.
STILL_TIMES = 3
# The most of these queries: they last five minutes, as long as the library waits.
MOST_TIMES = 300
# The library waits this long after the motors got power.
POWER_SECONDS = 1.0
HOME_SPEED = 20
# The pose of a Mercury at rest; other arms stretch all joints.
MERCURY_HOME = (0, 0, 0, 0, 0, 90, 0)
# The number of the setting that makes the arm report the end of motions.
REPORTS_ENDS = 2
# Registers of tools.
VERSION_REGISTER, PINCH_REGISTER = 1, 52


class ClosedLoop(CompatibleClient):
    """A robot that accepts a motion at once, and reports its end.

    A call that starts a motion waits for its end and returns its status, which is 0. If the motion
    fails, the call raises RequestRefused; with ``errors="return"`` it returns the status. If an
    error or Ctrl-C ends the wait, the arm is sent ``stop``, unless it stands still. With
    ``_async=True`` the call returns 1 at once.
    """

    QUIET: ClassVar[int | None] = DONE
    ACK_SECONDS: ClassVar[float] = 3.0
    # Whether calls wait for the ends of motions; whether the end of an earlier one may still come.
    _waits = True
    _others = False

    def _move(self, call: Callable[..., None], *arguments: Any, quiet: bool = False) -> Any:
        """Send a motion once, wait for its end, and return the status with which it ended."""
        if quiet or not self._waits:
            self._others = True
            return self._send_acked(call, *arguments, quiet=quiet)
        command = self.arm.table.in_role("motion ended")
        with self.arm.events(command.reply_type, timeout=QUERY_SECONDS) as ends:
            try:
                with self._stopping():
                    # The acceptance may be lost; only the report of the end counts.
                    with suppress(ReplyTimeout):
                        call(*arguments, ack_within=self.ACK_SECONDS)
                    end = self._end_of(call.__name__, ends)
                if isinstance(end, ReplyTimeout):
                    raise end
                refusal = command.refusal(end.fields)
                if refusal is not None and self._raises:
                    field, status = refusal
                    raise RequestRefused(f"{call.__name__}()", field, status, b"")
            except (ProtocolError, ReplyTimeout):
                return self._failed()
        return int(end.status)

    @contextmanager
    def _stopping(self) -> Iterator[None]:
        """Stop the arm if an error or Ctrl-C ends the wait for the end of a motion."""
        try:
            yield
        except UsageError:
            # Nothing was sent.
            raise
        except BaseException as error:
            # The motion may still report its end.
            self._others = True
            self.arm._stop_for(error)
            raise

    def _end_of(self, name: str, ends: Any) -> Any:
        """Return the event of the motion's end, or a ReplyTimeout if the arm does not report it.

        Raises:
            ReplyTimeout: the arm still moves after five minutes.
        """
        still, queries = 0, 0
        while still < STILL_TIMES and queries < MOST_TIMES:
            for end in ends:
                # The end of an earlier motion looks the same.
                if self._others and self.arm.is_moving():
                    continue
                self._others = False
                return end
            queries += 1
            with suppress(ReplyTimeout):
                still = 0 if self.arm.is_moving() else still + 1
        reports = "is_moving() is False" if still else "is_moving() is True"
        request = f"{name}() at the end of its motion"
        error = ReplyTimeout(name, queries * QUERY_SECONDS, (reports,), 1, request)
        if still < STILL_TIMES:
            raise error
        # The arm stands still: there is no motion to stop.
        return error

    def _not_ready(self, name: str, why: str) -> int:
        try:
            raise ArmNotReady(name, False, (why,))
        except ArmNotReady:
            return self._failed()

    def get_coords(self, angles: Sequence[float] | None = None) -> Any:
        """Read the coordinates, or calculate those of joint angles."""
        if angles is None:
            return self._query(plain, self.arm.get_coords)
        return self._query(plain, self.arm.angles_to_coords, angles)

    @naming(target="data")
    def is_in_position(self, data: Sequence[float], mode: int = 0) -> Any:
        """Check whether joint angles are reached, or coordinates if ``mode`` is 1."""
        if mode not in (0, 1):
            raise UsageError("mode", mode, "0 (angles) or 1 (coordinates)")
        query = self.arm.is_in_position_coords if mode else self.arm.is_in_position
        return self._query(plain, query, data)

    def power_on(self, mode: int = 1) -> Any:
        """Power the arm, and wait a second for its motors."""
        result = self._query(plain, self.arm.power_on, mode)
        self.arm.listen(POWER_SECONDS)
        return result

    def set_servos_calibration(self) -> None:
        """Make the present positions of all joints their zeros."""
        for joint in range(1, self.arm.table.joints + 1):
            self._send_acked(self.arm.set_servo_calibration, joint)


class Reporting(ClosedLoop):
    """A robot that can switch off its reports of the end of motions."""

    def get_limit_switch(self) -> Any:
        """Read whether checks of positions, and reports of the end of motions, are on."""
        result = self._query(plain, self.arm.get_limit_switch)
        if isinstance(result, list):
            self._waits = self._waits and bool(result[1])
        return result

    @naming(check="limit_mode", on="state")
    def set_limit_switch(self, limit_mode: int, state: int) -> Any:
        """Switch a check of positions, or the reports of the end of motions (2).

        Without these reports, motions return when they are accepted.

        Raises:
            UsageError: an argument is not allowed; nothing was sent, not even the query.
            ArmNotReady: the arm has no power; with ``errors="return"`` the result is -1.
        """
        check_range("limit_mode", limit_mode, 1, 2)
        check_range("state", state, 0, 1)
        powered = self.arm.is_power_on()
        if not powered:
            why = f"the arm has {no_power(powered)}; call power_on()"
            return self._not_ready("set_limit_switch", why)
        result = self._send_acked(self.arm.set_limit_switch, limit_mode, state)
        if limit_mode == REPORTS_ENDS:
            self._waits = bool(state)
        return result

    def power_on(self, mode: int = 1) -> Any:
        """Power the arm, and wait a second for its motors."""
        result = self._query(plain, self.arm.power_on, mode)
        if result == DONE:
            # The arm has power, even if this query fails.
            with suppress(ProtocolError, ReplyTimeout):
                self._waits = self._waits and bool(self.arm.get_limit_switch().motion_ends)
        self.arm.listen(POWER_SECONDS)
        return result

    @naming(address="gripper_address", gripper="gripper_id")
    def get_pro_gripper(self, gripper_address: int, gripper_id: int = 14) -> Any:
        """Read a register of a tool; register 1, the firmware version, is divided by 10."""
        gives = tenths if gripper_address == VERSION_REGISTER else plain
        return self._query(gives, self.arm.get_pro_gripper, gripper_address, gripper_id)

    def drag_teach_execute(self) -> Any:
        """Move along the recorded points, once.

        Raises:
            ArmNotReady: no points are recorded; with ``errors="return"`` the result is -1.
        """
        if not self.arm.is_drag_fifo_empty():
            why = "no points are recorded; record some with drag_teach_save()"
            return self._not_ready("drag_teach_execute", why)
        return self._move(self.arm.drag_teach_execute)

    def go_home(self, robot: int = 1, speed: int = HOME_SPEED, _async: bool = False) -> Any:
        """Move the arm to its rest pose; if ``robot`` is not 1, first move head and waist to 0."""
        if robot != 1:
            for joint in (11, 12, 13):
                self._move(self.arm.send_angle, joint, 0, speed)
        joints = self.arm.table.joints
        home = MERCURY_HOME if joints == len(MERCURY_HOME) else (0,) * joints
        return self._move(self.arm.send_angles, home, speed, quiet=_async)

    @naming(angles="degrees")
    def sync_send_angles(self, degrees: Sequence[float], speed: int, timeout: float = 15) -> int:
        """Move all joints to angles, and wait until they are there, as ``move_angles`` does.

        Raises:
            MotionTimeout: the arm does not arrive in time; it is then sent ``stop``. With
                ``errors="return"`` the result is then 0, as it is in the library.
            ProtocolError: the motion failed, or a reply is not allowed; with ``errors="return"``
                the result is 0.
        """
        try:
            self.arm.move_angles(degrees, speed, timeout=timeout)
        except (MotionTimeout, ProtocolError):
            if self._raises:
                raise
            return 0
        return DONE

    @naming(value="pinch_pose", gripper="gripper_id")
    def set_hand_gripper_pinch_action_speed_consort(
        self, pinch_pose: int, rank_mode: int, idle_flag: int | None = None, gripper_id: int = 14
    ) -> Any:
        """Let the fingers of a hand pinch.

        Raises:
            UsageError: an argument is not allowed, such as an ``idle_flag``: no document of the
                maker describes the message with it.
        """
        if idle_flag is not None:
            message = "set_hand_gripper_pinch_action_speed_consort() takes no idle_flag: no source"
            raise UsageError("idle_flag", idle_flag, message=f"{message} describes the message")
        check_range("pinch_pose", pinch_pose, 0, 4)
        check_range("rank_mode", rank_mode, 0, 5)
        value = pinch_pose << 8 | rank_mode
        return self._send_acked(self.arm.set_pro_gripper, PINCH_REGISTER, value, gripper_id)
