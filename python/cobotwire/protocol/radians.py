"""Degrees as radians and back, for single numbers and rows of them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any


def to_degrees(radians: Any) -> Any:
    """Return radians as degrees: a number or a row of numbers; anything else comes back as it is.

    The codec rejects what is not a number, and its message shows the value that the caller gave.
    """
    if _is_number(radians):
        return math.degrees(radians)
    if isinstance(radians, Iterable) and not isinstance(
        radians, (str, bytes, bytearray, dict, set)
    ):
        return [math.degrees(value) if _is_number(value) else value for value in radians]
    return radians


def to_radians(degrees: Any) -> Any:
    """Return degrees as radians: a number or a tuple of numbers."""
    if isinstance(degrees, tuple):
        return tuple(math.radians(value) for value in degrees)
    return math.radians(degrees)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
