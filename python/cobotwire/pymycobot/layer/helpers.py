"""The maker's methods that send several requests, or none."""

from __future__ import annotations

import time
from collections.abc import Sequence
from importlib import import_module
from typing import Any, ClassVar, Self

from cobotwire.protocol.errors import MotionTimeout, ProtocolError, UsageError
from cobotwire.pymycobot.layer.client import DONE, CompatibleClient
from cobotwire.pymycobot.layer.naming import naming

HOME_SPEED = 10


class Waiting(CompatibleClient):
    """Waits for a time, or for the end of a motion."""

    # The result of a motion that failed or did not end in time, if errors are returned.
    LATE: ClassVar[int] = DONE

    def wait(self, t: float) -> Self:
        """Sleep for some seconds."""
        time.sleep(t)
        return self

    @naming(angles="degrees")
    def sync_send_angles(self, degrees: Sequence[float], speed: int, timeout: float = 15) -> int:
        """Move all joints to angles, and wait until they are there, as ``move_angles`` does.

        Raises:
            MotionTimeout: the arm does not arrive in time; it is then sent ``stop``. With
                ``errors="return"`` the call returns what the library returns: 1, or 0 in its older
                classes.
            ProtocolError: the arm refuses the motion, or a reply is not allowed; otherwise as
                MotionTimeout.
        """
        return self._reached(self.arm.move_angles, degrees, speed, timeout=timeout)

    def _reached(self, move: Any, *arguments: Any, timeout: float) -> int:
        try:
            move(*arguments, timeout=timeout)
        except (MotionTimeout, ProtocolError):
            if self._raises:
                raise
            return self.LATE
        return DONE


class WaitingWithMode(Waiting):
    """Waits for the end of a motion to coordinates; the caller may choose the path."""

    def sync_send_coords(
        self, coords: Sequence[float], speed: int, mode: int = 0, timeout: float = 15
    ) -> int:
        """Move the end of the arm to coordinates, and wait for it, as ``move_coords`` does.

        Raises:
            MotionTimeout: as ``sync_send_angles``.
        """
        return self._reached(self.arm.move_coords, coords, speed, mode, timeout=timeout)


class WaitingForResult(WaitingWithMode):
    """Waits for the end of a motion, and returns whether it ended in time."""

    LATE = 0


class WaitingLonger(WaitingForResult):
    """Waits for the joints twice as long."""

    @naming(angles="degrees")
    def sync_send_angles(self, degrees: Sequence[float], speed: int, timeout: float = 30) -> int:
        """Move all joints to angles, and wait until they are there, as ``move_angles`` does.

        Raises:
            MotionTimeout: the arm does not arrive in time; it is then sent ``stop``. With
                ``errors="return"`` the result is then 0.
        """
        return self._reached(self.arm.move_angles, degrees, speed, timeout=timeout)


class WaitingWithoutMode(Waiting):
    """Waits for the end of a motion to coordinates."""

    def sync_send_coords(self, coords: Sequence[float], speed: int, timeout: float = 15) -> int:
        """Move the end of the arm to coordinates, and wait for it, as ``move_coords`` does.

        Raises:
            MotionTimeout: as ``sync_send_angles``.
        """
        return self._reached(self.arm.move_coords, coords, speed, timeout=timeout)


class WaitingInChain(Waiting):
    """Waits for the end of a motion, and returns the arm."""

    @naming(angles="degrees")
    def sync_send_angles(  # type: ignore[override]
        self, degrees: Sequence[float], speed: int, timeout: float = 15
    ) -> Self:
        """Move all joints to angles, and wait until they are there, as ``move_angles`` does.

        Raises:
            MotionTimeout: the arm does not arrive in time; it is then sent ``stop``. With
                ``errors="return"`` nothing is raised.
        """
        self._reached(self.arm.move_angles, degrees, speed, timeout=timeout)
        return self

    def sync_send_coords(
        self, coords: Sequence[float], speed: int, mode: int | None, timeout: float = 15
    ) -> Self:
        """Move the end of the arm to coordinates, and wait for it, as ``move_coords`` does.

        Raises:
            UsageError: there is a mode, which the edition cannot send.
            MotionTimeout: as ``sync_send_angles``.
        """
        self._lacks(mode=mode)
        self._reached(self.arm.move_coords, coords, speed, timeout=timeout)
        return self


class Homing(CompatibleClient):
    """Sends all joints to 0."""

    def go_home(self) -> Any:
        """Send all joints to 0 degrees, at a tenth of the fastest speed."""
        joints = self.arm.table.joints
        return self._send_acked(self.arm.send_angles, [0] * joints, HOME_SPEED)


class HomingQuietly(Homing):
    """Sends all joints to 0; may return without waiting for the acknowledgement."""

    def go_home(self, _async: bool = False) -> Any:
        """Send all joints to 0 degrees, at a tenth of the fastest speed."""
        joints = self.arm.table.joints
        return self._send_acked(self.arm.send_angles, [0] * joints, HOME_SPEED, quiet=_async)


class HomingWithoutResult(CompatibleClient):
    """Sends all joints to 0, and returns nothing."""

    def go_home(self) -> None:
        """Send all joints to 0 degrees, at a fifth of the fastest speed."""
        self._send(self.arm.send_angles, [0] * self.arm.table.joints, 20)


class HomingAndWaiting(Waiting):
    """Sends all joints to 0, and waits until they are there."""

    def go_home(self) -> None:
        """Move all joints to 0 degrees, at 30 percent of the fastest speed, and wait."""
        self.sync_send_angles([0] * self.arm.table.joints, 30)


class TorqueGripper(CompatibleClient):
    """A gripper with force control, whose kind can be read."""

    def is_torque_gripper(self) -> Any:
        """Read the kind of the gripper: 40 with force control, 9 without."""
        return self._query(int, self.arm.get_servo_data, 7, 1)


class StoppingGripper(TorqueGripper):
    """A gripper with force control, which can be stopped."""

    def gripper_stop(self) -> Any:
        """Stop the gripper."""
        return self._send_acked(self.arm.set_gripper_value, 0, 0, 1, 1)


class TwoPositions(CompatibleClient):
    """Checks two kinds of targets by one method, where the protocol has two commands."""

    @naming(angles="data", target="data", coords="data")
    def is_in_position(self, data: Sequence[float], id: int = 0) -> Any:
        """Check whether joint angles are reached, or coordinates if ``id`` is 1."""
        query = self.arm.is_in_position_coords if id == 1 else self.arm.is_in_position
        return self._query(int, query, data)


class Pins:
    """Pins of a Raspberry Pi, by the package RPi.GPIO."""

    def gpio_init(self) -> None:
        """Use the pins by the numbers of the processor (BCM)."""
        self.gpio: Any = import_module("RPi.GPIO")
        self.gpio.setmode(self.gpio.BCM)

    def gpio_output(self, pin: int, v: int) -> None:
        """Set a pin to 0 or 1.

        Raises:
            UsageError: ``gpio_init`` was not called.
        """
        if not hasattr(self, "gpio"):
            raise UsageError("pin", message="call gpio_init() before setting a pin")
        self.gpio.setup(pin, self.gpio.OUT)
        self.gpio.output(pin, v)
