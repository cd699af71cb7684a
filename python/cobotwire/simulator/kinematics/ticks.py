"""Encoder ticks, on which joints stop, and the rounding of what the firmware reports."""

from __future__ import annotations

import math
from collections.abc import Iterable

TICKS_PER_TURN = 4096
ZERO_TICK = 2048
# Exact in binary: any number of ticks is an exact number of degrees.
DEGREES_PER_TICK = 360 / TICKS_PER_TURN
# An encoder counts one turn; no joint can be further from its zero than half a turn.
HALF_TURN = 180.0


def on_tick(degrees: float) -> float:
    """Return the angle of the nearest tick."""
    return round(degrees / DEGREES_PER_TICK) * DEGREES_PER_TICK


def inside(lowest: float, highest: float) -> tuple[float, float]:
    """Return the outermost angles on ticks within limits; without any, the first is higher."""
    lowest, highest = max(lowest, -HALF_TURN), min(highest, HALF_TURN)
    return (
        math.ceil(lowest / DEGREES_PER_TICK) * DEGREES_PER_TICK,
        math.floor(highest / DEGREES_PER_TICK) * DEGREES_PER_TICK,
    )


def reported_angles(degrees: Iterable[float]) -> tuple[float, ...]:
    """Return angles as the firmware reports them: on ticks, truncated to hundredths."""
    return tuple(
        math.trunc(100 * round(angle / DEGREES_PER_TICK) * 360 / TICKS_PER_TURN) / 100
        for angle in degrees
    )


def reported_coords(coords: Iterable[float]) -> tuple[float, ...]:
    """Return coordinates as the firmware reports them: truncated to 0.1 mm and 0.01 degrees."""
    return tuple(
        math.trunc(value * scale) / scale for value, scale in zip(coords, (10,) * 3 + (100,) * 3)
    )


def encoder_at(degrees: float, sign: int) -> int:
    """Return the reading of a joint's encoder for an angle of the joint."""
    return ZERO_TICK + sign * round(degrees / DEGREES_PER_TICK)


def angle_at(encoder: int, sign: int) -> float:
    """Return the angle of a joint for a reading of its encoder."""
    return sign * (encoder - ZERO_TICK) * DEGREES_PER_TICK
