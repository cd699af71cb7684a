"""A smooth curve through points: its first and second derivative have no steps."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise

Point = tuple[float, ...]
Matrix = list[list[float]]
# The largest value between two points is found among this many samples.
SAMPLES = 4


class Curve:
    """A cubic spline through points, one for each knot; knots are distances or times.

    With ``rests`` it begins and ends at rest: speed and acceleration are zero. Then its first and
    last segments are quintics. Otherwise its ends are straight.
    """

    def __init__(self, knots: Sequence[float], points: Sequence[Point], *, rests: bool) -> None:
        """Take at least two points; the knots increase."""
        self._knots = list(knots)
        axes = [_segments(self._knots, axis, rests=rests) for axis in zip(*points)]
        # The coefficients of each axis, by segment.
        self._segments = list(zip(*axes))
        self.length = self._knots[-1]

    def at(self, knot: float, order: int = 0) -> Point:
        """Return the point at a distance or time, or a derivative there."""
        segment = min(max(bisect_right(self._knots, knot) - 1, 0), len(self._segments) - 1)
        return self._at(segment, knot - self._knots[segment], order)

    def largest(self, order: int) -> list[Point]:
        """Return the largest absolute value of a derivative for each axis, by segment."""
        found = []
        for segment, (start, end) in enumerate(pairwise(self._knots)):
            steps = ((end - start) * sample / SAMPLES for sample in range(SAMPLES + 1))
            rows = [self._at(segment, along, order) for along in steps]
            found.append(tuple(max(map(abs, axis)) for axis in zip(*rows)))
        return found

    def _at(self, segment: int, along: float, order: int) -> Point:
        return tuple(_value(axis, along, order) for axis in self._segments[segment])


def _value(polynomial: Sequence[float], x: float, order: int) -> float:
    total = 0.0
    for power in range(len(polynomial) - 1, order - 1, -1):
        factor = 1
        for each in range(order):
            factor *= power - each
        total = total * x + polynomial[power] * factor
    return total


def _segments(knots: list[float], values: Sequence[float], *, rests: bool) -> Matrix:
    """Return the coefficients of each segment of one axis."""
    steps = [b - a for a, b in pairwise(knots)]
    rises = [(b - a) / step for (a, b), step in zip(pairwise(values), steps)]
    speeds = _speeds(steps, rises, rests=rests)
    bends = [
        (6 * rise - 4 * v - 2 * w) / step
        for rise, step, (v, w) in zip(rises, steps, pairwise(speeds))
    ]
    bends.append((2 * speeds[-2] + 4 * speeds[-1] - 6 * rises[-1]) / steps[-1])
    if rests:
        bends[0] = bends[-1] = 0.0
    return [
        _quintic(step, value, rise, *ends)
        for step, value, rise, ends in zip(
            steps, values, rises, zip(speeds, speeds[1:], bends, bends[1:])
        )
    ]


def _quintic(
    step: float, value: float, rise: float, v: float, w: float, a: float, b: float
) -> list[float]:
    """Return the polynomial with a value, speeds v and w, and second derivatives a and b."""
    # What the terms of power 3, 4 and 5 must add by the end of the step: to the value, the speed
    # and the second derivative.
    distance = (rise - v - a * step / 2) * step
    speed = (w - v - a * step) * step
    bend = (b - a) * step * step
    return [
        value,
        v,
        a / 2,
        (10 * distance - 4 * speed + bend / 2) / step**3,
        (-15 * distance + 7 * speed - bend) / step**4,
        (6 * distance - 3 * speed + bend / 2) / step**5,
    ]


def _speeds(steps: list[float], rises: list[float], *, rests: bool) -> list[float]:
    """Return the first derivatives at the knots that make the second one continuous."""
    # Rows of a tridiagonal system: left, middle, right, and the right side.
    end = (1.0, 0.0, 0.0) if rests else (2.0, 1.0, 3.0)
    rows = [[0.0, end[0], end[1], end[2] * rises[0]]]
    for (h, k), (r, s) in zip(pairwise(steps), pairwise(rises)):
        rows.append([1 / h, 2 / h + 2 / k, 1 / k, 3 * (r / h + s / k)])
    rows.append([end[1], end[0], 0.0, end[2] * rises[-1]])
    for before, row in pairwise(rows):
        share = row[0] / before[1]
        row[1] -= share * before[2]
        row[3] -= share * before[3]
    speeds = [rows[-1][3] / rows[-1][1]]
    for row in reversed(rows[:-1]):
        speeds.append((row[3] - row[2] * speeds[-1]) / row[1])
    return speeds[::-1]
