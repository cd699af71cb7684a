"""Motions that are waited for."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from cobotwire.driver.blocking import Driver
from cobotwire.driver.opening import seconds
from cobotwire.errors import CobotwireError, ReplyTimeout
from cobotwire.session.motion import MOTION_SECONDS, Ask, Pause, Went, kind_of, until_reached


class Moving(Driver):
    """Moves the arm and waits for the end of it; by commands that the edition gives a role.

    Ctrl-C while it waits sends ``stop`` before KeyboardInterrupt goes on. The protocol is no
    emergency stop: a frame can be lost.
    """

    def move_angles(
        self,
        angles: Sequence[float],
        speed: int,
        *,
        wait: bool = True,
        timeout: float = MOTION_SECONDS,
    ) -> None:
        """Send all joints to angles, and wait until they are there.

        Args:
            angles: the target, in degrees, base first.
            speed: percent of the fastest.
            wait: False returns when the order is sent.
            timeout: seconds to wait at most.

        Raises:
            UsageError: an argument is not allowed; nothing was sent.
            LinkError: the link is gone.
            MotionTimeout: the arm is not there in time, or stands still short of it.
        """
        name = self.table.in_role("joint targets").name
        self._move(name, (angles, speed), "ANGLES", wait, timeout)

    def move_coords(
        self,
        coords: Sequence[float],
        speed: int,
        mode: int | None = None,
        *,
        wait: bool = True,
        timeout: float = MOTION_SECONDS,
    ) -> None:
        """Send the end to coordinates, and wait until it is there.

        Args:
            coords: the target: x, y, z in millimetres, rx, ry, rz in degrees.
            speed: percent of the fastest.
            mode: the path, as the edition's ``send_coords`` takes it; some can leave it out.
            wait: False returns when the order is sent.
            timeout: seconds to wait at most.

        Raises:
            UsageError: an argument is not allowed; nothing was sent.
            LinkError: the link is gone.
            MotionTimeout: the arm is not there in time, or stands still short of it.
        """
        name = self.table.in_role("coordinate targets").name
        values = (coords, speed) if mode is None else (coords, speed, mode)
        self._move(name, values, "COORDS", wait, timeout)

    def wait_until_reached(
        self, target: Sequence[float], kind: int = 0, *, timeout: float = MOTION_SECONDS
    ) -> None:
        """Wait until the arm is at a target to which it was sent.

        Args:
            target: angles in degrees, or coordinates in millimetres and degrees.
            kind: what the target is, as the edition's ``TargetKind`` says it.
            timeout: seconds to wait at most.

        Raises:
            UsageError: an argument is not allowed; nothing was sent.
            LinkError: the link is gone.
            MotionTimeout: the arm is not there in time, or stands still short of it.
        """
        seconds("timeout", timeout)
        try:
            self._wait(target, kind, timeout)
        except KeyboardInterrupt:
            self._stop()
            raise

    def _move(
        self, name: str, values: tuple[Any, ...], label: str, wait: bool, timeout: float
    ) -> None:
        seconds("timeout", timeout)
        try:
            self._tell(name, values)
            if wait:
                self._wait(values[0], kind_of(self.table, label), timeout)
        except KeyboardInterrupt:
            self._stop()
            raise

    def _wait(self, target: Sequence[float], kind: int, timeout: float) -> None:
        started = self._times.now()
        steps = until_reached(self.table, target, kind, timeout, started)
        step = next(steps)
        with suppress(StopIteration):
            while True:
                went = self._go(step)
                step = steps.send(went)

    def _go(self, step: Ask | Pause) -> Went:
        fields = None
        if isinstance(step, Pause):
            self._times.sleep(max(0.0, step.until - self._times.now()))
        else:
            with suppress(ReplyTimeout):
                fields = self._ask(step.name, step.values, longest=step.longest)
        return Went(self._times.now(), fields)

    def _stop(self) -> None:
        # What interrupts is told; that the arm could not be told, too, would hide it.
        with suppress(CobotwireError):
            self._tell(self.table.in_role("stop").name, ())
