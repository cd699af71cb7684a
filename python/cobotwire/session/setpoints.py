"""Where the joints should be at each tick of a path, or after the targets of a live source.

Times are numbers; nothing is sent here. A plan is stepped once for each tick that passed, whether
its setpoint was sent or not, so the joints' speeds stay those of the plan.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence

from cobotwire.kinematics import Geometry, Pose, coords_of, flange
from cobotwire.kinematics.coordinates import pose_with
from cobotwire.kinematics.curve import Curve, Point
from cobotwire.kinematics.jerk_limited import Along, Bounds, InTime, Tracker, excesses, paced
from cobotwire.kinematics.straight import angles_along, steps_between, straight_line
from cobotwire.protocol.errors import UsageError

# A waypoint at 0 s may be at most this far from where the arm is.
HERE_DEGREES = 1.0
# Two points that are nearer than this are one point of a path.
SAME_DEGREES = 1e-6
# The longest time over which the motion to a new target is spread.
SPREAD_SECONDS = 0.25


# Takes start, target and the number of steps (0: as many as the line needs). Returns the angles
# after each step; the last ones are the target. Raises UsageError if the joints cannot go there.
Interpolation = Callable[[Point, Point, int], list[Point]]


def evenly(start: Point, target: Point, steps: int) -> list[Point]:
    """Return the angles at each step; each joint turns evenly."""
    count = steps or 1
    return [
        tuple(a + (b - a) * step / count for a, b in zip(start, target))
        for step in range(1, count + 1)
    ]


class OnLines:
    """Interpolates between coordinates of the flange on straight lines."""

    def __init__(
        self,
        geometry: Geometry,
        indices: Sequence[int],
        limits: Sequence[tuple[float, float]],
    ) -> None:
        """``indices`` are those of the coordinates that a target has, among all six."""
        self._geometry, self._indices, self._limits = geometry, indices, limits

    def coords_at(self, angles: Point) -> Point:
        """Return the coordinates of the flange that a target has."""
        coords = coords_of(self._geometry, angles)
        return tuple(coords[index] for index in self._indices)

    def __call__(self, start: Point, target: Point, steps: int) -> list[Point]:
        """Return the angles after each step."""
        here = flange(self._geometry, start)
        end: Pose = pose_with(target, self._indices, here)
        count = steps or steps_between(here, end)
        line = straight_line(here, end, count)
        found = angles_along(self._geometry, line, start, self._limits)
        if len(found) < count:
            shown = ", ".join(f"{value:g}" for value in target)
            message = f"the joints cannot follow a straight line to ({shown})"
            raise UsageError("target", message=message)
        return found


class Path:
    """A path that is known before it begins."""

    def __init__(
        self,
        start: Point,
        waypoints: Sequence[tuple[Point, float | None]],
        interpolate: Interpolation,
        bounds: Bounds,
        rate: float,
    ) -> None:
        """Plan the path from where the joints are.

        Raises:
            UsageError: a waypoint cannot be reached, or not by its time.
        """
        self._rate, self._tick = rate, 0
        self._motion: Along | InTime | None = None
        timed = any(time is not None for _, time in waypoints)
        points, times = [start], [0.0]
        for number, (target, time) in enumerate(waypoints):
            added = _named(number, interpolate, points[-1], target)
            if timed:
                assert time is not None, "all waypoints have times, or none has"
                if time <= times[-1]:
                    _check_here(start, added[-1])
                    continue
                share = (time - times[-1]) / len(added)
                times += [times[-1] + share * (step + 1) for step in range(len(added))]
                points += added
            else:
                for point in added:
                    if max(abs(a - b) for a, b in zip(point, points[-1])) > SAME_DEGREES:
                        points.append(point)
        if len(points) > 1:
            self._motion = (
                _in_time(points, times, bounds) if timed else Along(paced(points, bounds), bounds)
            )
        self.seconds = self._motion.seconds if self._motion else 0.0
        self.ticks = math.ceil(self.seconds * rate - 1e-9)
        self.end = points[-1]

    @property
    def done(self) -> bool:
        """Whether the last setpoint was returned."""
        return self._tick >= self.ticks

    def at(self, tick: float) -> tuple[Point, float]:
        """Return where the joints should be at a tick, and the speed of the fastest one."""
        if self._motion is None or tick >= self.ticks:
            return self.end, 0.0
        return self._motion.at(tick / self._rate)

    def step(self, ticks: int) -> tuple[Point, float]:
        """Move on by some ticks; return the setpoint and the highest speed."""
        self._tick += ticks
        return self.at(self._tick)


class Live:
    """The setpoints that follow the targets of a source; each is nearer to the newest target.

    A new target is approached over the time that the source takes from one to the next, so that
    joints do not stop at each.
    """

    def __init__(
        self, start: Point, interpolate: Interpolation, bounds: Bounds, rate: float
    ) -> None:
        self._interpolate, self._rate = interpolate, rate
        self._tracker = Tracker(start, bounds, 1 / rate)
        self._aim: Point = start
        self._ahead: deque[Point] = deque()
        self._received_at: float | None = None
        self.moves = False

    @property
    def end(self) -> Point:
        """The newest target."""
        return self._ahead[-1] if self._ahead else self._aim

    @property
    def done(self) -> bool:
        """Whether the joints are at the newest target."""
        return not self._ahead and self._tracker.arrived

    def take(self, target: Point, now: float) -> None:
        """Approach a new target from now on.

        Raises:
            UsageError: the joints cannot go there.
        """
        gap = 0.0 if self._received_at is None else min(now - self._received_at, SPREAD_SECONDS)
        self._received_at, self.moves = now, True
        ticks = max(1, round(gap * self._rate))
        self._ahead = deque(self._interpolate(self._aim, target, ticks))

    def step(self, ticks: int) -> tuple[Point, float]:
        """Move on by some ticks; return the setpoint and the highest speed."""
        for _ in range(ticks):
            if self._ahead:
                self._aim = self._ahead.popleft()
            point, speed = self._tracker.step(self._aim)
        return point, speed


def _named(number: int, interpolate: Interpolation, start: Point, target: Point) -> list[Point]:
    try:
        return interpolate(start, target, 0)
    except UsageError as error:
        raise UsageError(f"path[{number}]", message=f"path[{number}]: {error}") from None


def _check_here(start: Point, point: Point) -> None:
    away = max(abs(a - b) for a, b in zip(start, point))
    if away > HERE_DEGREES:
        message = (
            f"path[0] is at 0 s, and the arm is {away:.1f} degrees away from it; give it time, or "
            "move the arm there first"
        )
        raise UsageError("path[0]", message=message)


def _in_time(points: list[Point], times: list[float], bounds: Bounds) -> InTime:
    """Return the motion through points at their times.

    Raises:
        UsageError: it would exceed the bounds.
    """
    motion = InTime(Curve(times, points, rests=True))
    for unit, each in zip(("°/s", "°/s²", "°/s³"), excesses(motion, bounds)):
        if each.needed > each.allowed:
            message = (
                f"the times of the path need {each.bound} {each.needed:.4g} {unit} of joint "
                f"{each.joint + 1}; allowed: {each.allowed:g} {unit}; make the times "
                f"{each.slower:.2f} times as long"
            )
            raise UsageError("path", message=message)
    return motion
