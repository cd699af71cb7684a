"""Read a file of known failures: each line has the name of a question, or a pattern of names.

    decode-values/get_encoder/*   the library reads the number as signed

The reason follows the name and is required. Empty lines, and lines that begin with ``#``, do not
count.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fnmatch import fnmatchcase

from cobotwire.protocol.errors import UsageError


@dataclass(slots=True)
class Expectation:
    """A line of the file; ``met`` counts the questions that failed as expected."""

    pattern: str
    reason: str
    place: str
    met: int = 0
    passed: list[str] = field(default_factory=list)


def read_expectations(text: str, name: str) -> list[Expectation]:
    """Return the lines of a file called ``name``.

    Raises:
        UsageError: a line has no reason, or repeats the name of another line.
    """
    found: dict[str, Expectation] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        pattern, _, reason = line.strip().partition(" ")
        place = f"{name}:{number}"
        if not reason.strip():
            message = (
                f"{place}: {line.strip()} has no reason; write the name, a space and the reason"
            )
            raise UsageError(place, message=message)
        if pattern in found:
            message = f"{place}: {pattern} is already in {found[pattern].place}"
            raise UsageError(place, message=message)
        found[pattern] = Expectation(pattern, reason.strip(), place)
    return list(found.values())


def expectation_of(expectations: list[Expectation], name: str) -> Expectation | None:
    """Return the first line that matches the name of a question."""
    return next((e for e in expectations if fnmatchcase(name, e.pattern)), None)
