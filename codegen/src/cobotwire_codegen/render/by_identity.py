"""Caches values that are derived from an object of the model."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, wraps
from typing import Generic, TypeVar

T = TypeVar("T")
Result = TypeVar("Result")
# The size of each cache: more than the number of commands of all editions.
_MOST = 8192


class _Same(Generic[T]):
    """A cache key: equal if both hold the same object. Hashing the object itself would be slow."""

    __slots__ = ("held",)

    def __init__(self, held: T) -> None:
        self.held = held

    def __hash__(self) -> int:
        return id(self.held)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.held is other.held


def by_identity(function: Callable[[T], Result]) -> Callable[[T], Result]:
    """Return a function that remembers its results, which must be immutable."""
    remembered = lru_cache(_MOST)(lambda same: function(same.held))

    @wraps(function)
    def remembering(argument: T) -> Result:
        return remembered(_Same(argument))

    return remembering
