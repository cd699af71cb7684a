"""Encoder ticks: what a joint stands on, and how the firmware rounds what it says of it."""

from __future__ import annotations

import math
from collections.abc import Iterable

TICKS_A_TURN = 4096
ZERO_TICK = 2048
# Exact in binary: whole numbers of ticks are exact numbers of degrees.
DEGREES_A_TICK = 360 / TICKS_A_TURN
# An encoder counts one turn; no joint is held further from its zero than half of that.
HALF_TURN = 180.0


def on_tick(degrees: float) -> float:
    """The angle of the tick that is nearest."""
    return round(degrees / DEGREES_A_TICK) * DEGREES_A_TICK


def inside(lowest: float, highest: float) -> tuple[float, float]:
    """The outermost ticks' angles within limits; the first is above the second if there is none."""
    lowest, highest = max(lowest, -HALF_TURN), min(highest, HALF_TURN)
    return (
        math.ceil(lowest / DEGREES_A_TICK) * DEGREES_A_TICK,
        math.floor(highest / DEGREES_A_TICK) * DEGREES_A_TICK,
    )


def told_angles(degrees: Iterable[float]) -> tuple[float, ...]:
    """Angles as the firmware tells them: the tick's, cut to hundredths towards zero."""
    return tuple(
        math.trunc(100 * round(angle / DEGREES_A_TICK) * 360 / TICKS_A_TURN) / 100
        for angle in degrees
    )


def told_coords(coords: Iterable[float]) -> tuple[float, ...]:
    """Coordinates as the firmware tells them: cut to 0.1 mm and 0.01 degrees towards zero."""
    return tuple(
        math.trunc(value * scale) / scale for value, scale in zip(coords, (10,) * 3 + (100,) * 3)
    )


def encoder_at(degrees: float, sign: int) -> int:
    """The encoder's reading of a joint at an angle."""
    return ZERO_TICK + sign * round(degrees / DEGREES_A_TICK)


def angle_at(encoder: int, sign: int) -> float:
    """The angle of a joint whose encoder reads so much."""
    return sign * (encoder - ZERO_TICK) * DEGREES_A_TICK
