"""Damped least squares: the angles inside the limits, near given ones, that come nearest to a pose.

Each step solves a small system of linear equations in plain Python. A joint that reaches a limit
stays there until a step leads it back.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import mul

from cobotwire.kinematics.forward import frames
from cobotwire.kinematics.geometry import Angles, Geometry
from cobotwire.kinematics.nearness import Limits
from cobotwire.kinematics.pose import Pose, Vector, cross

# The most steps of one descent, and of all descents for one request. A step takes about 0.1 ms, and
# a reply must not wait for a search.
STEPS, STEPS_OF_A_REQUEST = 60, 80
# The descent ends after PATIENCE steps in a row that each cut the distance by less than PROGRESS.
PROGRESS, PATIENCE = 0.02, 8
# The damping of a step: at first, and the least, in square millimetres.
DAMPING, LEAST_DAMPING = 10.0, 1e-8
# A step that would turn a joint further than this is shortened, in degrees.
LONGEST_STEP = 40.0
# The distance, in millimetres, below which a further step is not worth its time.
CLOSE = 1e-6
X, Y, Z = 0, 1, 2


class Effort:
    """The steps that the descents for one request may still take.

    Steps are counted, not time: so a simulated arm does the same on any machine and any clock.
    """

    def __init__(self, steps: int = STEPS_OF_A_REQUEST) -> None:
        self.left = steps

    def spend(self, steps: int = 1) -> None:
        """Count steps that were taken."""
        self.left = max(0, self.left - steps)


def descend(
    geometry: Geometry,
    target: Pose,
    start: Sequence[float],
    limits: Limits,
    radian: float,
    effort: Effort,
) -> Angles:
    """Return angles inside the limits, near ``start``, at which the flange is nearest to a target.

    A turn by one radian counts as a distance of ``radian`` millimetres. If the ``effort`` is used
    up first, return the nearest angles so far.
    """
    angles, damping = clamped(start, limits), DAMPING
    here = frames(geometry, angles)
    errors = _errors(here[-1], target, radian)
    distance = best = math.hypot(*errors)
    waited = 0
    for _ in range(STEPS):
        if distance < CLOSE or waited > PATIENCE or not effort.left:
            break
        effort.spend()
        step = _step(_columns(geometry, here, radian), errors, damping, angles, limits)
        tried = clamped([angle + turn for angle, turn in zip(angles, step)], limits)
        frames_there = frames(geometry, tried)
        errors_there = _errors(frames_there[-1], target, radian)
        distance_there = math.hypot(*errors_there)
        if distance_there < distance:
            angles, here, errors, distance = tried, frames_there, errors_there, distance_there
            damping = max(damping / 10, LEAST_DAMPING)
        else:
            damping = damping * 10
        if distance < best * (1 - PROGRESS):
            best, waited = distance, 0
        else:
            waited += 1
    return tuple(angles)


def _errors(here: Pose, target: Pose, radian: float) -> list[float]:
    """Return how far the flange has to move and to turn, in millimetres along each axis."""
    turn = [0.0, 0.0, 0.0]
    for one, other in zip(here[:3], target[:3]):
        turn = [a + b for a, b in zip(turn, cross(one, other))]
    shift = [b - a for a, b in zip(here.origin, target.origin)]
    sine = math.hypot(*turn) / 2
    cosine = (sum(_dot(one, other) for one, other in zip(here[:3], target[:3])) - 1) / 2
    angle = math.atan2(sine, cosine)
    scale = radian * (angle / (2 * sine) if sine > 1e-9 else 0.5)
    if sine <= 1e-9 and cosine < 0:
        # For half a turn the cross products are zero, so the axis is unknown: turn about x.
        return [*shift, *(math.pi * radian * part for part in here.x)]
    return [*shift, *(scale * part for part in turn)]


def _columns(geometry: Geometry, here: Sequence[Pose], radian: float) -> list[list[float]]:
    """Return for each joint how a degree of it moves and turns the flange."""
    columns = [[0.0] * 6 for _ in range(geometry.joints)]
    end = here[-1].origin
    axis: Vector = (0.0, 0.0, 1.0)
    origin: Vector = (0.0, 0.0, 0.0)
    for turns, frame in zip(geometry.turns, here):
        if turns:
            lever = (end[X] - origin[X], end[Y] - origin[Y], end[Z] - origin[Z])
            moved = cross(axis, lever)
            for joint, share in turns:
                column, weight = columns[joint], math.radians(share)
                for row in range(3):
                    column[row] += moved[row] * weight
                    column[row + 3] += axis[row] * weight * radian
        axis, origin = frame.z, frame.origin
    return columns


def _step(
    columns: Sequence[Sequence[float]],
    errors: Sequence[float],
    damping: float,
    angles: Sequence[float],
    limits: Limits,
) -> list[float]:
    """Return how far each joint turns; joints at a limit do not turn beyond it."""
    free = list(range(len(columns)))
    step = [0.0] * len(columns)
    while free:
        weights = _solve(_squares([columns[joint] for joint in free], damping), errors)
        blocked = []
        for joint in free:
            turn = sum(map(mul, columns[joint], weights))
            low, high = limits[joint]
            step[joint] = turn
            if (turn < 0 and angles[joint] <= low) or (turn > 0 and angles[joint] >= high):
                blocked.append(joint)
        if not blocked:
            break
        for joint in blocked:
            step[joint] = 0.0
            free.remove(joint)
    longest = max(map(abs, step))
    return step if longest <= LONGEST_STEP else [turn * LONGEST_STEP / longest for turn in step]


def _squares(columns: Sequence[Sequence[float]], damping: float) -> list[list[float]]:
    """Return the columns times their transpose, with the damping on the diagonal."""
    rows = list(zip(*columns))
    squares = [[0.0] * len(rows) for _ in rows]
    for i, one in enumerate(rows):
        for j in range(i + 1):
            squares[i][j] = squares[j][i] = sum(map(mul, one, rows[j]))
        squares[i][i] += damping
    return squares


def _solve(matrix: list[list[float]], right: Sequence[float]) -> list[float]:
    """Solve linear equations with a symmetric, positive matrix, by elimination."""
    rows = [[*row, value] for row, value in zip(matrix, right)]
    size = len(rows)
    for pivot in range(size):
        top = rows[pivot]
        for row in rows[pivot + 1 :]:
            share = row[pivot] / top[pivot]
            if share:
                row[pivot:] = [a - share * b for a, b in zip(row[pivot:], top[pivot:])]
    solved = [0.0] * size
    for index in reversed(range(size)):
        row = rows[index]
        rest = row[size] - sum(map(mul, row[index + 1 : size], solved[index + 1 :]))
        solved[index] = rest / row[index]
    return solved


def clamped(angles: Sequence[float], limits: Limits) -> list[float]:
    """Return the angles, each moved to the nearest one inside its limits."""
    return [min(max(angle, low), high) for angle, (low, high) in zip(angles, limits)]


def _dot(one: Vector, other: Vector) -> float:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
