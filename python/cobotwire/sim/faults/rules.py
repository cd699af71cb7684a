"""What a field of a scenario may hold. A rule gives the value as it is kept, or what is allowed.

One rule serves both ways in: Python objects are checked by it when they are made, and what a YAML
file says is checked by it before, so that the file's place can be told.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import field
from difflib import get_close_matches
from typing import Any

Rule = Callable[[Any], Any]
"""Raises ValueError with what is allowed."""

LONGEST_SECONDS = 86_400.0
RULE = "rule"


def ruled(rule: Rule, default: Any) -> Any:
    """A field of a dataclass that keeps to a rule."""
    return field(default=default, metadata={RULE: rule})


def number(lowest: float, highest: float) -> Rule:
    """A number between two bounds."""

    def rule(value: Any) -> float:
        # A truth value is a number to Python, not to a reader of scenarios.
        fits = isinstance(value, int | float) and not isinstance(value, bool)
        if not fits or not lowest <= value <= highest:
            raise ValueError(f"a number from {lowest:g} to {highest:g}")
        return float(value)

    return rule


def whole(lowest: int, highest: int) -> Rule:
    """A whole number between two bounds."""

    def rule(value: Any) -> int:
        if not isinstance(value, int) or isinstance(value, bool) or not lowest <= value <= highest:
            raise ValueError(f"a whole number from {lowest} to {highest}")
        return int(value)

    return rule


def optional(rule: Rule) -> Rule:
    """What the rule allows, or nothing."""
    return lambda value: None if value is None else rule(value)


def one_of(words: Iterable[str]) -> Rule:
    """A word from a closed list."""
    known = tuple(words)

    def rule(value: Any) -> str:
        if value not in known:
            raise ValueError(f"one of {', '.join(known)}{nearest(value, known)}")
        return str(value)

    return rule


class Several:
    """One value, or a list of them; kept as a tuple."""

    def __init__(self, one: Rule) -> None:
        self.one = one

    def __call__(self, value: Any) -> tuple[Any, ...]:
        """Each value by the rule for one."""
        values = value if isinstance(value, list | tuple) else [value]
        return tuple(self.one(item) for item in values)


def command(value: Any) -> str | int:
    """The name of a command; or the id of a request, where no name is known for it."""
    if isinstance(value, str) and value:
        return str(value)
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 0xFF:
        return int(value)
    raise ValueError("a command's name, or an id from 0 to 0xFF")


def pairs_of_hex(value: Any) -> bytes:
    """Bytes, or pairs of hex digits; at least one, at most 4096."""
    try:
        data = value if isinstance(value, bytes) else bytes.fromhex(value)
    except (TypeError, ValueError):
        data = b""
    if not 1 <= len(data) <= 4096:
        raise ValueError("1 to 4096 bytes as pairs of hex digits, in quotes")
    return data


SECONDS = number(0, LONGEST_SECONDS)
SHARE = number(0, 1)


def nearest(given: Any, known: Iterable[str]) -> str:
    """A hint for a misspelt word; empty where nothing is like it."""
    near = get_close_matches(given, list(known), n=1) if isinstance(given, str) else []
    return f"; did you mean {near[0]}?" if near else ""
