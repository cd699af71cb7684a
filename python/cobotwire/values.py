"""Small helpers of the generated methods: optional arguments, and radians for degrees."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any


def given(*values: Any) -> tuple[Any, ...]:
    """The values up to the last one that was given; the codec refuses a None before that."""
    last = max((index for index, value in enumerate(values) if value is not None), default=-1)
    return values[: last + 1]


def to_degrees(radians: Any) -> Any:
    """Radians as degrees: a number, or a row of them; anything else is left as it is."""
    if _is_number(radians):
        return math.degrees(radians)
    if isinstance(radians, Iterable) and not isinstance(
        radians, (str, bytes, bytearray, dict, set)
    ):
        return [math.degrees(value) if _is_number(value) else value for value in radians]
    return radians


def to_radians(degrees: Any) -> Any:
    """Degrees as radians: a number, or a row of them."""
    if isinstance(degrees, tuple):
        return tuple(math.radians(value) for value in degrees)
    return math.radians(degrees)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
