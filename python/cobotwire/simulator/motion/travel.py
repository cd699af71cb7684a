"""The travel of one number to its next standstill. Time begins at 0."""

from __future__ import annotations

import math

# After this many halvings, an interval of 300 degrees per second is below a double's resolution.
BISECTIONS = 60


class Travel:
    """Covers the signed distance ``way`` in ``duration`` seconds: changes to a cruise, then brakes.

    It begins at ``speed``, and speeds up and slows down at ``acceleration``. :func:`quickest` and
    :func:`lasting` find the cruising speed.
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
        self._ramped = (speed + cruise) / 2 * self._changed

    def at(self, time: float) -> float:
        """Return how far it has moved."""
        if time < self._changed:
            return (self._speed + self._change * time / 2) * time
        if time < self._brakes:
            return self._ramped + self._cruise * (time - self._changed)
        left = self.duration - time
        return self._way - self._braking * left * left / 2 if left > 0 else self._way

    def speed(self, time: float) -> float:
        """Return how fast it is."""
        if time < self._changed:
            return self._speed + self._change * time
        return self._cruise if time < self._brakes else self._braking * (self.duration - time)


def quickest(speed: float, way: float, fastest: float, acceleration: float) -> Travel:
    """Return the travel over ``way`` that takes the least time, at ``fastest`` at most."""
    # The position where it would stop if it braked now decides the direction of cruising.
    brake = speed * abs(speed) / (2 * acceleration)
    if way == brake:
        return braking(speed, acceleration)
    forth = math.copysign(1.0, way - brake)
    peak = math.sqrt(max(forth * acceleration * way + speed * speed / 2, 0.0))
    cruise = forth * min(peak, fastest)
    ramp_up = (speed + cruise) / 2 * abs(cruise - speed) / acceleration
    ramp_down = cruise * abs(cruise) / (2 * acceleration)
    # A target very near the stopping point gives a cruising speed of 0.
    cruising = max((way - ramp_up - ramp_down) / cruise, 0.0) if cruise else 0.0
    ramps = (abs(cruise - speed) + abs(cruise)) / acceleration
    return Travel(speed, cruise, way, acceleration, ramps + cruising)


def lasting(speed: float, way: float, acceleration: float, duration: float) -> Travel:
    """Return the travel over ``way`` that takes ``duration``, at least that of the quickest."""
    # The way grows with the cruising speed, so bisection finds the speed.
    slowest = (speed - acceleration * duration) / 2
    fastest = (speed + acceleration * duration) / 2
    for _ in range(BISECTIONS):
        cruise = (slowest + fastest) / 2
        if _way_of(speed, cruise, acceleration, duration) < way:
            slowest = cruise
        else:
            fastest = cruise
    return Travel(speed, cruise, way, acceleration, duration)


def braking(speed: float, acceleration: float) -> Travel:
    """Return the travel that brakes from ``speed``."""
    way = speed * abs(speed) / (2 * acceleration)
    return Travel(speed, 0.0, way, acceleration, abs(speed) / acceleration)


def _way_of(speed: float, cruise: float, acceleration: float, duration: float) -> float:
    changing, braking = abs(cruise - speed) / acceleration, abs(cruise) / acceleration
    cruising = duration - changing - braking
    return (speed + cruise) / 2 * changing + cruise * cruising + cruise / 2 * braking
