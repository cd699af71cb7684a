"""Failures that are known and expected: a file with a name, or a pattern of names, a line.

    decode-values/get_encoder/*   the library reads the word as signed

Everything behind the name is the reason, and there must be one. Empty lines, and lines that begin
with ``#``, do not count.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fnmatch import fnmatchcase

from cobotwire.errors import UsageError


@dataclass(slots=True)
class Expectation:
    """A line of the file; ``met`` counts the trials that failed as it says."""

    pattern: str
    reason: str
    place: str
    met: int = 0
    passed: list[str] = field(default_factory=list)


def read_expectations(text: str, name: str) -> list[Expectation]:
    """The lines of a file called ``name``.

    Raises:
        UsageError: a line has no reason, or a name stands there twice.
    """
    found: dict[str, Expectation] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        pattern, _, reason = line.strip().partition(" ")
        place = f"{name}:{number}"
        if not reason.strip():
            raise UsageError(place, line.strip(), "the name of a trial, a space, and the reason")
        if pattern in found:
            raise UsageError(place, pattern, f"a name that is not in {found[pattern].place} too")
        found[pattern] = Expectation(pattern, reason.strip(), place)
    return list(found.values())


def expectation_of(expectations: list[Expectation], name: str) -> Expectation | None:
    """The first line that speaks of a trial."""
    return next((e for e in expectations if fnmatchcase(name, e.pattern)), None)
