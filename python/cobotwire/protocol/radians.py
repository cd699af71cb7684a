"""Convert degrees to radians and back, for single numbers and rows of numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any


def to_degrees(radians: Any) -> Any:
    """Convert a number or a row of numbers to degrees; return anything else unchanged.

    The codec rejects values that are not numbers, and its message shows them as they were given.
    """
    if _is_number(radians):
        return math.degrees(radians)
    if isinstance(radians, Iterable) and not isinstance(
        radians, (str, bytes, bytearray, dict, set)
    ):
        return [math.degrees(value) if _is_number(value) else value for value in radians]
    return radians


def to_radians(degrees: Any) -> Any:
    """Convert a number or a tuple of numbers to radians."""
    if isinstance(degrees, tuple):
        return tuple(math.radians(value) for value in degrees)
    return math.radians(degrees)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
