"""Decide which Python values are numbers."""

from __future__ import annotations

from typing import Any, SupportsFloat, SupportsIndex

# Types with an index or a float value. Comparing the first two is fast; comparing types of other
# libraries, such as NumPy, is not.
NUMBERS = (float, int, SupportsFloat, SupportsIndex)


def is_number(value: Any) -> bool:
    """Return whether a value has a float value, and is no boolean."""
    if isinstance(value, bool) or not isinstance(value, NUMBERS):
        return False
    # NumPy's boolean has a float value, but is no ``bool``.
    return isinstance(value, float) or (getattr(getattr(value, "dtype", None), "kind", None) != "b")
