"""What differs between the maker's classes and ours, and the rulings on it.

``differences.txt`` has a section for each reason, and in it a row for each difference: method,
part, what differs, and the classes that have it, separated by tabs.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

RULED = Path(__file__).with_name("differences.txt")
# The reasons begin with this mark.
SECTION = "## "


class Difference(NamedTuple):
    """What differs in a method: ``part`` is a parameter, the frames or the result."""

    method: str
    part: str
    shows: str


class Ruled(NamedTuple):
    """The reason for a difference."""

    why: str
    names: frozenset[str]


@lru_cache(maxsize=1)
def rulings() -> dict[Difference, list[Ruled]]:
    """Return the rulings by their difference; a difference may have another reason elsewhere."""
    found: dict[Difference, list[Ruled]] = {}
    why = ""
    for line in RULED.read_text().splitlines():
        if line.startswith(SECTION):
            why = line.removeprefix(SECTION)
        elif line and not line.startswith("#"):
            method, part, shows, names = line.split("\t")
            ruled = Ruled(why, frozenset(names.split("; ")))
            found.setdefault(Difference(method, part, shows), []).append(ruled)
    return found


def unruled(name: str, found: Iterable[Difference], methods: Iterable[str], part: str) -> list[str]:
    """Return what has no ruling, and the rulings on these methods that nothing needs any more.

    ``part`` says what was compared: ``values``, ``calls`` or ``replies``.
    """
    differing, compared = set(found), set(methods)
    ruled = {
        each
        for each, reasons in rulings().items()
        if any(name in reason.names for reason in reasons) and part_of(each) == part
    }
    gone = {each for each in ruled - differing if each.method in compared}
    left = [f"no ruling: {_text(name, each)}" for each in sorted(differing - ruled)]
    return left + [f"no longer differs: {_text(name, each)}" for each in sorted(gone)]


def part_of(difference: Difference) -> str:
    """Return which comparison shows a difference."""
    return {"conversation": "calls", "reply": "replies"}.get(difference.part, "values")


def _text(name: str, each: Difference) -> str:
    return f"{name}.{each.method}, {each.part}: {each.shows}"


def relation(theirs: Any, ours: Any) -> str:
    """Return how two results differ: by their kinds, a factor, a sign, or their values."""
    kinds = kind_of(theirs), kind_of(ours)
    if kinds[0] != kinds[1]:
        return f"{kinds[1]}, not {kinds[0]}"
    pairs = [*zip(numbers_of(theirs), numbers_of(ours), strict=True)]
    for factor in (10, 100, 1000, 0.1, 0.01, 0.001):
        if pairs and all(abs(a - b * factor) < 1e-6 * max(1, abs(a)) for a, b in pairs):
            return f"{kinds[0]}, the library's times {factor}"
    if pairs and all(isinstance(a - b, int) and (b - a) % 256 == 0 for a, b in pairs):
        return f"{kinds[0]} with another sign"
    return f"{kinds[0]} of other values"


def kind_of(result: Any) -> str:
    """Return the type of a result and of its parts, in words."""
    if isinstance(result, list | tuple):
        parts = [kind_of(each) for each in result]
        if len(set(parts)) <= 1:
            return f"{type(result).__name__} of {len(parts)} {parts[0] if parts else ''}".strip()
        return f"{type(result).__name__} of {' '.join(parts)}"
    if isinstance(result, str) and result.startswith(("the ", "rejected", "fail", "wait")):
        return result
    return str(result) if result is None or result in (-1,) else type(result).__name__


def numbers_of(result: Any) -> list[Any]:
    """Return the numbers of a result, in one list."""
    if isinstance(result, list | tuple):
        return [number for each in result for number in numbers_of(each)]
    return [result] if isinstance(result, int | float) else []
