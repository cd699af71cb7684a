"""Legs: the motion of axes to their next standstill, from standstill or at full speed.

Each leg has a ``duration`` in seconds and an ``end``. Its methods return the positions and speeds
of the axes after a time, the leg on which all axes brake, and the motion that remains then.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

from cobotwire.simulator.motion.travel import Travel, braking, lasting, quickest

Point = tuple[float, ...]
# Two steps of a route count as even if their lengths differ by less than this share.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Plan:
    """A motion that is still to be made.

    Attributes:
        points: the points to pass; the last one is the target.
        rate: the speed, in units per second.
    """

    points: tuple[Point, ...]
    rate: float


class Route:
    """A motion along points that are close to each other, from standstill to standstill.

    In each step, the axis that moves farthest has the speed and acceleration of the route. On a
    bent route, half of the acceleration is reserved for the bends, so that no axis exceeds it.
    """

    def __init__(self, points: Sequence[Point], rate: float, acceleration: float) -> None:
        self._points = points
        steps = (max(abs(b - a) for a, b in zip(one, two)) for one, two in pairwise(points))
        self._reached = [0.0, *accumulate(steps)]
        self._rate = rate
        bend = _sharpest_bend(points, self._reached)
        if bend > 0:
            acceleration /= 2
            rate = min(rate, math.sqrt(acceleration / bend))
        self._begin(0.0, quickest(0.0, self._reached[-1], rate, acceleration))

    def _begin(self, start: float, travel: Travel) -> None:
        """Travel along the route, from ``start`` units after its first point."""
        self._start, self._travel = start, travel
        self.duration = travel.duration
        self.end = self.position(self.duration)

    def position(self, time: float) -> Point:
        """Return where the axes are."""
        return self._at(self._done(time))

    def speed(self, time: float) -> Point:
        """Return how fast each axis is."""
        step = self._step(self._done(time))
        length = self._reached[step + 1] - self._reached[step]
        share = self._travel.speed(time) / length if length else 0.0
        return tuple((b - a) * share for a, b in zip(*self._points[step : step + 2]))

    def braked(self, time: float, acceleration: float) -> Route:
        """Return the same route, braked: the axes stay on it."""
        stopped = object.__new__(Route)
        stopped.__dict__.update(self.__dict__)
        stopped._begin(self._done(time), braking(self._travel.speed(time), acceleration))
        return stopped

    def rest(self) -> Plan:
        """Return the points ahead."""
        done = self._done(self.duration)
        ahead = [
            point for point, reached in zip(self._points, self._reached) if reached > done
        ] or [self._points[-1]]
        return Plan(tuple(ahead), self._rate)

    def _done(self, time: float) -> float:
        return self._start + self._travel.at(time)

    def _step(self, done: float) -> int:
        return min(max(bisect_right(self._reached, done) - 1, 0), len(self._points) - 2)

    def _at(self, done: float) -> Point:
        if done >= self._reached[-1]:
            return self._points[-1]
        step = self._step(done)
        length = self._reached[step + 1] - self._reached[step]
        share = (done - self._reached[step]) / length
        return tuple(a + (b - a) * share for a, b in zip(*self._points[step : step + 2]))


class Turn:
    """A change to another target during a motion: each axis on its own, all arrive together."""

    def __init__(self, start: Point, speed: Point, target: Point, rate: float, most: float) -> None:
        self._start, self._rate = start, rate
        self._target = target
        ways = [b - a for a, b in zip(start, target)]
        takes = max(quickest(v, way, rate, most).duration for v, way in zip(speed, ways))
        self._travels = [lasting(v, way, most, takes) for v, way in zip(speed, ways)]
        self.duration, self.end = takes, target

    def position(self, time: float) -> Point:
        """Return where the axes are."""
        return tuple(a + one.at(time) for a, one in zip(self._start, self._travels))

    def speed(self, time: float) -> Point:
        """Return how fast each axis is."""
        return tuple(one.speed(time) for one in self._travels)

    def braked(self, time: float, acceleration: float) -> Brake:
        """Return the leg on which each axis brakes on its own."""
        return Brake(self.position(time), self.speed(time), self.rest(), acceleration)

    def rest(self) -> Plan:
        """Return the target."""
        return Plan((self._target,), self._rate)


class Brake:
    """Each axis brakes as fast as it can."""

    def __init__(self, start: Point, speed: Point, plan: Plan, acceleration: float) -> None:
        self._start, self._plan = start, plan
        self._travels = [braking(v, acceleration) for v in speed]
        self.duration = max(one.duration for one in self._travels)
        self.end = self.position(self.duration)

    def position(self, time: float) -> Point:
        """Return where the axes are."""
        return tuple(
            a + one.at(min(time, one.duration)) for a, one in zip(self._start, self._travels)
        )

    def speed(self, time: float) -> Point:
        """Return how fast each axis is."""
        return tuple(one.speed(min(time, one.duration)) for one in self._travels)

    def braked(self, time: float, acceleration: float) -> Brake:
        """Return a leg that continues to brake."""
        return Brake(self.position(time), self.speed(time), self._plan, acceleration)

    def rest(self) -> Plan:
        """Return the motion that was left when braking began."""
        return self._plan


Leg = Route | Turn | Brake


def _sharpest_bend(points: Sequence[Point], reached: Sequence[float]) -> float:
    """Return the largest change of an axis's direction over a unit of the route."""
    slopes = [
        [(b - a) / (done - before) if done > before else 0.0 for a, b in zip(one, two)]
        for (one, two), (before, done) in zip(pairwise(points), pairwise(reached))
    ]
    sharpest = 0.0
    for index, (before, after) in enumerate(pairwise(slopes)):
        length = (reached[index + 2] - reached[index]) / 2
        change = max(abs(b - a) for a, b in zip(before, after))
        if change > ROUNDING and length > 0:
            sharpest = max(sharpest, change / length)
    return sharpest
