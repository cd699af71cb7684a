"""Motion by hand: the arm's joints are led along points at given times."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from pathlib import Path

from cobotwire.protocol.errors import UsageError

Point = tuple[float, ...]
TimedPoint = tuple[float, Point]
"""Seconds since the arm was released, and the angle of each joint in degrees."""


class Hand:
    """A part of a motion in which a person leads the joints, at constant speed between points."""

    def __init__(self, points: Sequence[TimedPoint], offset: float = 0.0) -> None:
        """Begin at the time ``offset`` of the points, in seconds."""
        self._points, self._offset = tuple(points), offset
        self._times = [time for time, _ in points]
        self.duration = self._times[-1] - offset
        self.end = points[-1][1]

    def position(self, time: float) -> Point:
        """Return where the axes are."""
        (start, first), (end, last) = self._around(time)
        share = 1.0 if end <= start else min((self._offset + time - start) / (end - start), 1.0)
        return tuple(a + (b - a) * share for a, b in zip(first, last))

    def speed(self, time: float) -> Point:
        """Return how fast each axis is."""
        (start, first), (end, last) = self._around(time)
        return tuple((b - a) / (end - start) if end > start else 0.0 for a, b in zip(first, last))

    def braked(self, time: float, acceleration: float) -> Hand:
        """Return the rest of the motion: no command stops the person's hand."""
        return Hand(self._points, self._offset + time)

    def _around(self, time: float) -> tuple[TimedPoint, TimedPoint]:
        after = min(max(bisect_right(self._times, self._offset + time), 1), len(self._points) - 1)
        return self._points[after - 1], self._points[after]


def checked(points: Iterable[tuple[float, Sequence[float]]], joints: int) -> tuple[TimedPoint, ...]:
    """Return timed points as tuples of floats.

    Raises:
        UsageError: a time is not after the one before, or a point has not one angle per joint.
    """
    found: list[TimedPoint] = []
    for seconds, angles in points:
        before = found[-1][0] if found else -1e-9
        if not before < seconds < math.inf:
            raise UsageError("seconds", seconds, "0 or more, and more than at the point before")
        if len(angles) != joints or not all(map(math.isfinite, angles)):
            raise UsageError("angles", list(angles), f"{joints} angles in degrees")
        found.append((float(seconds), tuple(map(float, angles))))
    return tuple(found)


def read_points(path: str | Path, joints: int) -> tuple[TimedPoint, ...]:
    """Read timed points: a line each, with seconds and then the angles; ``#`` begins a comment.

    Raises:
        UsageError: the file cannot be read, or a line is not a timed point.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError("led", message=f"{path}: {reason}") from None
    found: list[TimedPoint] = []
    for number, line in enumerate(lines, 1):
        words = line.partition("#")[0].replace(",", " ").split()
        if not words:
            continue
        try:
            values = [float(word) for word in words]
            found = list(checked([*found, (values[0], values[1:])], joints))
        except UsageError as error:
            raise UsageError("led", message=f"{path}:{number}: {error}") from None
        except ValueError:
            shown = f"expected seconds and {joints} angles, found {line.strip()!r}"
            raise UsageError("led", message=f"{path}:{number}: {shown}") from None
    if not found:
        raise UsageError("led", message=f"{path}: there is no point in the file")
    return tuple(found)
