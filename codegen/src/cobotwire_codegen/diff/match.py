"""Matches old items with new ones: by a key, by content, by position in a list."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, Generic, TypeVar

from cobotwire_codegen.diff import words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.errors import Place

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Matched(Generic[T]):
    """Two lists, and the pairs of indices (old, new) of matching items."""

    old: Sequence[T]
    new: Sequence[T]
    places: tuple[tuple[int, int], ...] = ()

    @property
    def pairs(self) -> list[tuple[T, T]]:
        """The matching items."""
        return [(self.old[i], self.new[j]) for i, j in self.places]

    @property
    def removed(self) -> list[T]:
        """The old items without a match."""
        stayed = {i for i, _ in self.places}
        return [item for i, item in enumerate(self.old) if i not in stayed]

    @property
    def added(self) -> list[T]:
        """The new items without a match."""
        stayed = {j for _, j in self.places}
        return [item for j, item in enumerate(self.new) if j not in stayed]

    def further(self, key: Callable[[T], object]) -> Matched[T]:
        """Match the remaining items by a key; equal keys are paired in order."""
        old_open = [i for i in range(len(self.old)) if i not in {i for i, _ in self.places}]
        new_open = [j for j in range(len(self.new)) if j not in {j for _, j in self.places}]
        more = []
        for i in old_open:
            j = next((j for j in new_open if key(self.new[j]) == key(self.old[i])), None)
            if j is not None:
                new_open.remove(j)
                more.append((i, j))
        return Matched(self.old, self.new, tuple(sorted((*self.places, *more))))


def match(old: Sequence[T], new: Sequence[T], key: Callable[[T], object]) -> Matched[T]:
    """Return the items of two lists matched by a key."""
    return Matched(old, new).further(key)


def order(where: str, matched: Matched[T], label: Callable[[T], str]) -> Iterator[Finding]:
    """Report matching items that changed their order."""
    stayed = [j for _, j in matched.places]
    moved = [j for j, straight in zip(stayed, sorted(stayed)) if j != straight]
    if moved:
        shown = [
            words.names(label(matched.new[j]) for j in side) for side in (moved, sorted(moved))
        ]
        yield finding("order-changed", where, *map(words.short, shown))


def renamed(old: Sequence[str], new: Sequence[str]) -> dict[str, str] | None:
    """Return the new name of each renamed item; None if the lists differ in another way."""
    changed = {a: b for a, b in zip(old, new) if a != b}
    same_places = len(old) == len(new) and not set(changed) & set(new)
    return changed if same_places and not set(changed.values()) & set(old) else None


def bare(value: Any) -> Any:
    """Return a part of the model without its places, for comparison."""
    if isinstance(value, tuple):
        return tuple(bare(item) for item in value)
    if is_dataclass(value) and not isinstance(value, type):
        parts = ((field.name, getattr(value, field.name)) for field in fields(value))
        inner = ((name, bare(part)) for name, part in parts if not isinstance(part, Place))
        return (type(value).__name__, *inner)
    return value
