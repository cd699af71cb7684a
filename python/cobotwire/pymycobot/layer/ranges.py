"""Rejects numbers that the edition allows and the maker's library does not."""

from __future__ import annotations

from cobotwire.protocol.errors import UsageError


def check_range(name: str, value: object, lowest: int, highest: int) -> None:
    """Check a whole number.

    Raises:
        UsageError: it is not a whole number, or outside of the range.
    """
    if not isinstance(value, int) or not lowest <= value <= highest:
        raise UsageError(name, value, f"a whole number {lowest}..{highest}")
