"""Motions with limited speed, acceleration and jerk, by ruckig: the extra ``motion``.

Ruckig's community edition plans from any state to one target; a path with several waypoints is a
:class:`~cobotwire.kinematics.curve.Curve`, along which one number moves.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from importlib import import_module
from itertools import accumulate, pairwise
from operator import truediv
from statistics import median
from typing import Any, NamedTuple

from cobotwire.kinematics.curve import Curve, Point
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.lazy import import_aside

# A derivative that is smaller than this counts as zero.
STRAIGHT = 1e-9
# A joint that leaves the range from its position to its target by more than this has passed an end.
PASSED_DEGREES = 1e-8
# How often bends are slowed down further, and what counts as slow enough.
ROUNDS, ENOUGH = 30, 1.02
# The longest time between two checks of a motion, and the least number of checks.
SAMPLE_SECONDS, LEAST_SAMPLES = 0.005, 200


class Bounds(NamedTuple):
    """The largest speed, acceleration and jerk of each joint, in degrees and seconds."""

    speed: Point
    acceleration: Point
    jerk: Point


def load_ruckig() -> Any:
    """Return the module ``ruckig``.

    Raises:
        UsageError: it is not installed.
    """
    import_aside("ruckig")
    try:
        return import_module("ruckig")
    except ImportError:
        message = "follow() needs ruckig: pip install 'cobotwire[motion]'"
        raise UsageError("ruckig", message=message) from None


class Along:
    """A motion along a curve, from rest to rest, within bounds; times are seconds from its start.

    The speed along the curve is the highest that the sharpest bend allows.
    """

    def __init__(self, curve: Curve, bounds: Bounds) -> None:
        ruckig = load_ruckig()
        self._curve = curve
        speed, acceleration, jerk = _along(curve, bounds)
        wanted = ruckig.InputParameter(1)
        wanted.current_position, wanted.target_position = [0.0], [curve.length]
        wanted.max_velocity, wanted.max_acceleration = [speed], [acceleration]
        wanted.max_jerk = [jerk]
        self._law = ruckig.Trajectory(1)
        ruckig.Ruckig(1).calculate(wanted, self._law)
        self._slower = 1.0
        self.seconds: float = self._law.duration
        # A bend and a change of speed may coincide; a slower motion obeys all bounds.
        self._slower = max(1.0, *(each.slower for each in excesses(self, bounds)))
        self.seconds *= self._slower

    def at(self, time: float) -> tuple[Point, float]:
        """Return where the joints are, and the speed of the fastest one."""
        (done,), (pace,), _ = self._law.at_time(time / self._slower)
        speeds = self._curve.at(done, 1)
        return self._curve.at(done), pace / self._slower * max(map(abs, speeds))


class InTime:
    """A motion along a curve whose parameter is time."""

    def __init__(self, curve: Curve) -> None:
        self._curve, self.seconds = curve, curve.length

    def at(self, time: float) -> tuple[Point, float]:
        """Return where the joints are, and the speed of the fastest one."""
        return self._curve.at(time), max(map(abs, self._curve.at(time, 1)))


class Excess(NamedTuple):
    """How much of a bound a motion needs, for the joint that needs the largest share of it.

    ``slower`` is how many times as long the motion would have to take to just reach the bound.
    """

    bound: str
    joint: int
    needed: float
    allowed: float
    slower: float


def excesses(motion: Along | InTime, bounds: Bounds) -> list[Excess]:
    """Return how a motion uses each of the bounds, from positions at short intervals."""
    samples = max(LEAST_SAMPLES, math.ceil(motion.seconds / SAMPLE_SECONDS))
    step = motion.seconds / samples
    rows = [motion.at(sample * step)[0] for sample in range(samples + 1)]
    # The joints rest before and after the motion.
    rows = [rows[0]] * 3 + rows + [rows[-1]] * 3
    found = []
    for order, (bound, most) in enumerate(zip(Bounds._fields, bounds), 1):
        rows = [tuple((b - a) / step for a, b in zip(*pair)) for pair in pairwise(rows)]
        needed = [max(map(abs, axis)) for axis in zip(*rows)]
        shares = list(map(truediv, needed, most))
        joint = shares.index(max(shares))
        slower = shares[joint] ** (1 / order)
        found.append(Excess(bound, joint, needed[joint], most[joint], slower))
    return found


class Tracker:
    """Moves joints towards a target that may change at each step, and stops them there.

    The joints arrive together, if none of them has to pass its target for that. Otherwise each
    joint takes the shortest time.
    """

    def __init__(self, start: Point, bounds: Bounds, step: float) -> None:
        """Rest at first; ``step`` is the time of a step in seconds."""
        ruckig = load_ruckig()
        joints = len(start)
        self._ruckig, self._new_law = ruckig.Ruckig(joints), partial(ruckig.Trajectory, joints)
        self._failure = ruckig.RuckigError
        self._together, self._alone = ruckig.Synchronization.Time, ruckig.Synchronization.No
        self._state = ruckig.InputParameter(joints)
        self._state.current_position = list(start)
        self._state.max_velocity = list(bounds.speed)
        self._state.max_acceleration = list(bounds.acceleration)
        self._state.max_jerk = list(bounds.jerk)
        self._step, self._time = step, 0.0
        self._target: list[float] = []
        self._plan(list(start))
        self.arrived = True

    def step(self, target: Sequence[float]) -> tuple[Point, float]:
        """Advance by one step; return where the joints are, and the highest speed."""
        aim, state = list(target), self._state
        # Ruckig finds no motion from about one state in a million. The joints then continue to
        # their previous target for a step.
        if aim != self._target and not self._plan(aim) and self._time > self._law.duration:
            raise self._failure(f"no motion leads to {aim}")
        self._time += self._step
        found = self._law.at_time(self._time)
        state.current_position, state.current_velocity, state.current_acceleration = found
        self.arrived = aim == self._target and self._time > self._law.duration
        return tuple(found[0]), max(map(abs, found[1]))

    def _plan(self, target: list[float]) -> bool:
        """Plan the motion to a target; return whether there is one."""
        self._state.target_position = target
        for way in (self._together, self._alone):
            self._state.synchronization, law = way, self._new_law()
            with suppress(self._failure):
                self._ruckig.calculate(self._state, law)
                if way == self._alone or not self._passes(law):
                    self._law, self._time, self._target = law, 0.0, target
                    return True
        return False

    def _passes(self, law: Any) -> bool:
        """Return whether a motion leaves the range from the position to the target of a joint."""
        ranges = zip(self._state.current_position, self._state.target_position)
        return any(
            reached.min < min(ends) - PASSED_DEGREES or reached.max > max(ends) + PASSED_DEGREES
            for ends, reached in zip(ranges, law.position_extrema)
        )


def paced(points: Sequence[Point], bounds: Bounds) -> Curve:
    """Return a curve through points on which a speed of 1 is nearly within the bounds everywhere.

    The speed is constant where possible: the fastest joint determines the time between points.
    Near sharper bends more time is allowed, until the joints can follow.
    """
    steps = [
        max(map(truediv, (abs(b - a) for a, b in zip(one, two)), bounds.speed))
        for one, two in pairwise(points)
    ]
    for number in range(ROUNDS):
        curve = Curve([0.0, *accumulate(steps)], points, rests=False)
        needs = [max(need) for need in zip(*(_needs(curve, order, bounds) for order in (1, 2, 3)))]
        if max(needs) < ENOUGH:
            break
        if number == 0:
            needs = [median(needs)] * len(needs)
        steps = [step * max(1.0, need) for step, need in zip(steps, needs)]
    return curve


def _needs(curve: Curve, order: int, bounds: Bounds) -> list[float]:
    """Return how many times as long each segment must take to keep a derivative in its bound."""
    most = bounds[order - 1]
    return [max(map(truediv, each, most)) ** (1 / order) for each in curve.largest(order)]


def _along(curve: Curve, bounds: Bounds) -> tuple[float, float, float]:
    """Return limits of speed, acceleration and jerk along a curve; each ignores the other two."""
    speed = 1 / max(max(_needs(curve, order, bounds)) for order in (1, 2, 3))
    first = [max((STRAIGHT, *axis)) for axis in zip(*curve.largest(1))]
    acceleration = min(map(truediv, bounds.acceleration, first))
    return speed, acceleration, min(map(truediv, bounds.jerk, first))
