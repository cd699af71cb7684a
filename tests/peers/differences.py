"""What differs between the maker's classes and ours, and the rulings on it.

``differences.txt`` has a section for each reason. A row states differences with this reason:
methods, their parts, the difference, and classes, separated by tabs.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from pymycobot_classes import library

RULED = Path(__file__).with_name("differences.txt")
# The reasons begin with this mark.
SECTION = "## "
ALL = 3
# Begins the range in a difference of values; a row without a range applies to any.
RANGE = "; ours sends"
CALLS, REPLIES = ("conversation",), ("of the edition", "documented", "with its number", "any")


class Difference(NamedTuple):
    """What differs in a method: ``part`` is a parameter, the conversation or a kind of reply."""

    method: str
    part: str
    shows: str


class Ruling(NamedTuple):
    """The reason for differences of some methods of some classes."""

    why: str
    methods: frozenset[str]
    parts: frozenset[str]
    shows: str
    names: frozenset[str]

    def rules(self, name: str, each: Difference) -> bool:
        """Return whether a difference of a class has this reason."""
        shows = each.shows if RANGE in self.shows else each.shows.partition(RANGE)[0]
        same = name in self.names and shows == self.shows
        return same and each.method in self.methods and each.part in self.parts


@lru_cache(maxsize=1)
def rulings() -> list[Ruling]:
    """Return all rulings."""
    found, why = [], ""
    for line in RULED.read_text().splitlines():
        if line.startswith(SECTION):
            why = line.removeprefix(SECTION)
        elif line and not line.startswith("#"):
            methods, parts, shows, names = line.split("\t")
            found.append(Ruling(why, _list(methods), _list(parts), shows, _list(names)))
    return found


def _list(text: str) -> frozenset[str]:
    return frozenset(text.split("; "))


def unruled(name: str, found: Iterable[Difference]) -> list[str]:
    """Return the differences of a class that have no ruling."""
    left = [each for each in found if not any(ruling.rules(name, each) for ruling in rulings())]
    return [f"no ruling: {_text(name, each)}" for each in sorted(left)]


def stale(
    name: str, found: Collection[Difference], compared: Mapping[str, Collection[str]]
) -> list[str]:
    """Return the rulings that fit no difference of a class.

    ``compared`` has the compared methods, by what was compared: ``values``, ``calls``, ``replies``.
    If all three were compared, a ruling can be stale even if some of its methods were not compared.
    """
    left = []
    for ruling in rulings():
        methods = ruling.methods & set(dir(library(name)))
        parts = set(_comparisons(ruling))
        is_compared = len(compared) == ALL or all(methods <= {*compared.get(p, ())} for p in parts)
        is_needed = any(ruling.rules(name, each) for each in found)
        if name in ruling.names and is_compared and not is_needed:
            example = Difference(min(methods), min(ruling.parts), ruling.shows)
            left.append(f"no longer differs: {_text(name, example)}")
    return left


def unused(found: Collection[tuple[str, Difference]]) -> Iterator[str]:
    """Yield methods and parts of rulings that fit no difference of any class."""
    for ruling in rulings():
        needed = [each for name, each in found if ruling.rules(name, each)]
        methods = ruling.methods - {each.method for each in needed}
        parts = ruling.parts - {each.part for each in needed}
        for each in sorted(methods | parts):
            yield f"no longer differs in any class: {each}, {ruling.shows}"


def _comparisons(ruling: Ruling) -> Iterator[str]:
    """Yield which comparisons show the differences of a ruling."""
    for part in ruling.parts:
        yield "calls" if part in CALLS else "replies" if part in REPLIES else "values"


def _text(name: str, each: Difference) -> str:
    return f"{name}.{each.method}, {each.part}: {each.shows}"


def relation(theirs: Any, ours: Any) -> str:
    """Return how two results differ: by their kinds, a factor, a sign, or their values."""
    kinds = kind_of(theirs), kind_of(ours)
    if kinds[0] != kinds[1]:
        return f"{kinds[1]}, not {kinds[0]}"
    numbers = numbers_of(theirs), numbers_of(ours)
    if len(numbers[0]) != len(numbers[1]):
        return f"{kinds[0]} of other sizes"
    pairs = [*zip(*numbers, strict=True)]
    for factor in (10, 100, 1000, 0.1, 0.01, 0.001):
        if pairs and all(abs(a - b * factor) < 1e-6 * max(1, abs(a)) for a, b in pairs):
            return f"{kinds[0]}, the library's times {factor}"
    if pairs and all(isinstance(a - b, int) and (b - a) % 256 == 0 for a, b in pairs):
        return f"{kinds[0]} with another sign"
    return f"{kinds[0]} of other values"


def kind_of(result: Any) -> str:
    """Return the type of a result and of its parts, in words; for lists inside it, only "list"."""
    if isinstance(result, list | tuple):
        parts = ["list" if isinstance(each, list) else kind_of(each) for each in result]
        counts = ", ".join(f"{parts.count(part)} {part}" for part in dict.fromkeys(parts))
        return f"{type(result).__name__} of {counts or 0}"
    if isinstance(result, str) and result.startswith(("the ", "rejected", "fail", "wait")):
        return result
    return str(result) if result is None or result in (-1,) else type(result).__name__


def numbers_of(result: Any) -> list[Any]:
    """Return the numbers of a result, in one list."""
    if isinstance(result, list | tuple):
        return [number for each in result for number in numbers_of(each)]
    return [result] if isinstance(result, int | float) else []
