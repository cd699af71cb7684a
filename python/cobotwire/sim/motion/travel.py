"""One number that moves until it stands: from standing, or from moving. Time begins at 0."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol


class Travel(Protocol):
    """How far something is, by time."""

    @property
    def duration(self) -> float:
        """After how many seconds it stands."""
        ...

    def at(self, time: float) -> float:
        """How far it is, at 0..duration."""
        ...

    def speed(self, time: float) -> float:
        """How fast it is, at 0..duration."""
        ...


class Ramped:
    """From ``speed`` over a cruising speed to standing, ``way`` further, in ``duration`` seconds.

    It speeds up and slows down at ``acceleration``. :func:`quickest` and :func:`lasting` find the
    cruising speed.
    """

    def __init__(
        self, speed: float, cruise: float, way: float, acceleration: float, duration: float
    ) -> None:
        self.duration = duration
        self._speed, self._cruise, self._way = speed, cruise, way
        self._change = math.copysign(acceleration, cruise - speed)
        self._braking = math.copysign(acceleration, cruise)
        self._changed = abs(cruise - speed) / acceleration
        self._brakes = duration - abs(cruise) / acceleration
        self._behind = (speed + cruise) / 2 * self._changed

    def at(self, time: float) -> float:
        """How far it is."""
        if time < self._changed:
            return (self._speed + self._change * time / 2) * time
        if time < self._brakes:
            return self._behind + self._cruise * (time - self._changed)
        left = self.duration - time
        return self._way - self._braking * left * left / 2 if left > 0 else self._way

    def speed(self, time: float) -> float:
        """How fast it is."""
        if time < self._changed:
            return self._speed + self._change * time
        return self._cruise if time < self._brakes else self._braking * (self.duration - time)


def quickest(speed: float, way: float, fastest: float, acceleration: float) -> Ramped:
    """The travel over ``way`` that takes the least time, never speeding up above ``fastest``."""
    # Where it would stand if it braked now decides which way to cruise.
    brake = speed * abs(speed) / (2 * acceleration)
    if way == brake:
        return braking(speed, acceleration)
    forth = math.copysign(1.0, way - brake)
    peak = math.sqrt(max(forth * acceleration * way + speed * speed / 2, 0.0))
    cruise = forth * min(peak, fastest)
    behind = (speed + cruise) / 2 * abs(cruise - speed) / acceleration
    before = cruise * abs(cruise) / (2 * acceleration)
    # Turned back at a point that is next to where it would stand, it cruises at nothing.
    cruising = max((way - behind - before) / cruise, 0.0) if cruise else 0.0
    ramps = (abs(cruise - speed) + abs(cruise)) / acceleration
    return Ramped(speed, cruise, way, acceleration, ramps + cruising)


def lasting(speed: float, way: float, acceleration: float, duration: float) -> Ramped:
    """The travel over ``way`` that takes just ``duration``, which is not below the quickest."""
    # The way grows with the cruising speed, so it can be halved down to.
    slowest = (speed - acceleration * duration) / 2
    fastest = (speed + acceleration * duration) / 2
    for _ in range(BISECTIONS):
        cruise = (slowest + fastest) / 2
        if _way_of(speed, cruise, acceleration, duration) < way:
            slowest = cruise
        else:
            fastest = cruise
    return Ramped(speed, cruise, way, acceleration, duration)


# Halves 300 degrees a second down to less than a double can tell.
BISECTIONS = 60


def braking(speed: float, acceleration: float) -> Ramped:
    """The travel that stands as soon as it can."""
    way = speed * abs(speed) / (2 * acceleration)
    return Ramped(speed, 0.0, way, acceleration, abs(speed) / acceleration)


def _way_of(speed: float, cruise: float, acceleration: float, duration: float) -> float:
    changing, braking = abs(cruise - speed) / acceleration, abs(cruise) / acceleration
    cruising = duration - changing - braking
    return (speed + cruise) / 2 * changing + cruise * cruising + cruise / 2 * braking


@dataclass(frozen=True)
class Further:
    """A travel that begins somewhere else than at 0."""

    start: float
    travel: Travel

    @property
    def duration(self) -> float:
        """After how many seconds it stands."""
        return self.travel.duration

    def at(self, time: float) -> float:
        """How far it is."""
        return self.start + self.travel.at(time)

    def speed(self, time: float) -> float:
        """How fast it is."""
        return self.travel.speed(time)
