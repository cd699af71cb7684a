"""Which values a field of a scenario may have. A rule returns the value to keep.

Each rule serves objects and files: Python objects are checked when they are created, and the values
of a YAML file before that, so that an error can name the place in the file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import field
from typing import Any

from cobotwire.protocol.errors import did_you_mean

Rule = Callable[[Any], Any]
"""Raises a ValueError that says which values are allowed."""

LONGEST_SECONDS = 86_400.0
RULE = "rule"


def ruled(rule: Rule, default: Any) -> Any:
    """Declare a field of a dataclass, with the rule for its values."""
    return field(default=default, metadata={RULE: rule})


def number(lowest: float, highest: float) -> Rule:
    """Allow numbers between two bounds."""

    def rule(value: Any) -> float:
        # In Python a bool is a number; in a scenario it is not.
        fits = isinstance(value, int | float) and not isinstance(value, bool)
        if not fits or not lowest <= value <= highest:
            raise ValueError(f"a number from {lowest:g} to {highest:g}")
        return float(value)

    return rule


def integer(lowest: int, highest: int) -> Rule:
    """Allow whole numbers between two bounds."""

    def rule(value: Any) -> int:
        if not isinstance(value, int) or isinstance(value, bool) or not lowest <= value <= highest:
            raise ValueError(f"a whole number from {lowest} to {highest}")
        return int(value)

    return rule


def optional(rule: Rule) -> Rule:
    """Allow None in addition to what the rule allows."""
    return lambda value: None if value is None else rule(value)


def one_of(words: Iterable[str]) -> Rule:
    """Allow the words of a list."""
    known = tuple(words)

    def rule(value: Any) -> str:
        if value not in known:
            raise ValueError(f"one of {', '.join(known)}{did_you_mean(value, known)}")
        return str(value)

    return rule


class Several:
    """Allows one value, or a list of values; keeps a tuple."""

    def __init__(self, one: Rule, *, empty: bool = True) -> None:
        """Apply the rule ``one`` to each value; ``empty`` allows a list without values."""
        self.one, self.empty = one, empty

    def __call__(self, value: Any) -> tuple[Any, ...]:
        """Return each value as its rule keeps it."""
        values = value if isinstance(value, list | tuple) else [value]
        if not values and not self.empty:
            raise ValueError("at least one value")
        return tuple(self.one(item) for item in values)


def command(value: Any) -> str | int:
    """Allow the name of a command, or the id of a request that has no name."""
    if isinstance(value, str) and value:
        return str(value)
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 0xFFFF:
        return int(value)
    raise ValueError("a command's name, or an id from 0 to 0xFFFF")


def pairs_of_hex(value: Any) -> bytes:
    """Allow 1 to 4096 bytes, as bytes or as pairs of hex digits."""
    try:
        data = value if isinstance(value, bytes) else bytes.fromhex(value)
    except (TypeError, ValueError):
        data = b""
    if not 1 <= len(data) <= 4096:
        raise ValueError("1 to 4096 bytes as pairs of hex digits, in quotes")
    return data


SECONDS = number(0, LONGEST_SECONDS)
SHARE = number(0, 1)
