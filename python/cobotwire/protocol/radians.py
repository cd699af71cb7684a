"""Convert degrees to radians and back, for single numbers and rows of numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from cobotwire.protocol.number_types import is_number


def to_degrees(radians: Any) -> Any:
    """Convert a number or a row of numbers to degrees; return anything else unchanged.

    The codec rejects values that are not numbers, and its message shows them as they were given.
    """
    if is_number(radians):
        return _degrees(radians)
    if isinstance(radians, Iterable) and not isinstance(
        radians, (str, bytes, bytearray, dict, set)
    ):
        return [_degrees(value) if is_number(value) else value for value in radians]
    return radians


def to_radians(degrees: Any) -> Any:
    """Convert a number or a tuple of numbers to radians."""
    if isinstance(degrees, tuple):
        return tuple(math.radians(value) for value in degrees)
    return math.radians(degrees)


def _degrees(radians: Any) -> Any:
    try:
        return math.degrees(radians)
    except (OverflowError, TypeError, ValueError):
        return radians
