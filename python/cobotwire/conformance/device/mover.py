"""Moves the arm to poses inside the workspace, and waits until it stands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cobotwire.conformance.device.bench import Bench
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.trial import Case
from cobotwire.table import Command

Pose = tuple[float, ...]
# Shares of each joint's range in the workspace: no joint stands as another one, nor at zero. From
# the last three, where the arm is bent, the end can go a little way nearly anywhere.
POSES = (
    (0.71, 0.37, 0.62, 0.29, 0.83, 0.17),
    (0.33, 0.68, 0.41, 0.77, 0.21, 0.58),
    (0.58, 0.22, 0.12, 0.57, 0.62, 0.44),
    (0.44, 0.30, 0.05, 0.78, 0.36, 0.66),
    (0.58, 0.06, 0.72, 0.94, 0.83, 0.52),
)
# A joint stands on an encoder tick, 360/4096 degrees, and its angle is cut to hundredths.
TICK_DEGREES = 360 / 4096
ANGLE_TOLERANCE = TICK_DEGREES + 0.01
# How often an arm that moves is asked, and how long one motion may last, in seconds.
POLL = 0.05
LONGEST = 30.0


class Mover:
    """The arm's motion, by the roles of the edition's commands."""

    def __init__(self, case: Case) -> None:
        """Get ready to move.

        Raises:
            Unsupported: the edition lacks a role, or the arm has no power and may not get any.
        """
        self.case = case
        self.bench = case.bench
        self.targets = self._in_role("joint targets")
        self.joints = self._in_role("joints")
        self.speed = self.bench.leave.max_speed or 1
        give_power(self.bench)
        self._come_back()

    def pose(self, which: int) -> Pose:
        """One of the poses, in degrees."""
        ranges = self.bench.leave.workspace
        shares = (POSES[which][at % len(POSES[which])] for at in range(len(ranges)))
        return tuple(
            round(low + share * (high - low), 2) for share, (low, high) in zip(shares, ranges)
        )

    def go(self, pose: Pose) -> None:
        """Move there, and wait until the arm stands."""
        self.bench.ask(self.targets, (pose, self.speed))
        self.wait()

    def wait(self) -> None:
        """Wait until the arm says that it stands."""
        moving = self.bench.command("moving")
        until = self.bench.line.now + LONGEST
        while moving is not None and self.bench.line.now < until:
            self.rest(POLL)
            fields = self.bench.read(moving)
            if fields is not None and not any(fields.values()):
                return

    def settle(self, read: Callable[[], object]) -> None:
        """Wait until the arm stands and a reading stays: a gripper moves by itself."""
        self.wait()
        until, same, last = self.bench.line.now + LONGEST, 0, read()
        while same < 2 and self.bench.line.now < until:
            self.rest(POLL)
            now = read()
            same, last = (same + 1 if now == last else 0), now

    def rest(self, seconds: float) -> None:
        """Let time pass; what is heard meanwhile is asked for by nobody."""
        self.bench.line.clock.sleep(seconds)

    def angles(self) -> Pose:
        """Where the joints stand, in degrees."""
        fields = self.bench.read(self.joints)
        if fields is None:
            raise Unsupported(f"{self.joints.name} tells nothing")
        return tuple(next(iter(fields.values())))

    def _in_role(self, role: Any) -> Command:
        command = self.bench.command(role)
        if command is None:
            raise Unsupported(f"the edition has no command in the role {role}")
        return command

    def _come_back(self) -> None:
        """At the end of the run the arm goes back to where it stood, if that is inside."""
        ranges = self.bench.leave.workspace
        stood = self.angles()
        inside = all(low <= angle <= high for angle, (low, high) in zip(stood, ranges))
        if inside and "pose" not in self.bench.undo_last:
            self.bench.undo_last["pose"] = lambda: self.go(stood)


def off_by(pose: Pose, wanted: Pose) -> list[str]:
    """In words: the joints that are not where they should be."""
    return [
        f"joint {at}: sent to {want} degree, stands at {have}"
        for at, (have, want) in enumerate(zip(pose, wanted), 1)
        if abs(have - want) > ANGLE_TOLERANCE
    ]


def give_power(bench: Bench) -> None:
    """Switch the arm on if it is off; it is switched off again at the end of the run.

    Raises:
        Unsupported: it is off, and there is no leave.
    """
    powered = bench.command("powered")
    fields = None if powered is None else bench.read(powered)
    if powered is None or (fields is not None and any(fields.values())):
        return
    on, off = bench.switch(powered, 1), bench.switch(powered, 0)
    if on is None or "power" not in bench.leave.classes:
        raise Unsupported("the arm has no power, and there is no leave to switch it on")
    if off is not None:
        bench.undo_last["power"] = lambda: _send(bench, off)
    bench.ask(on)


def _send(bench: Bench, command: Command) -> None:
    bench.ask(command)
