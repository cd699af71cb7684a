"""Problems of a spec as data with a place; the command line formats them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

from cobotwire_codegen.legal import visible


@dataclass(frozen=True, slots=True, order=True)
class Place:
    """A position in a file; lines and columns count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{visible(self.file)}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """One problem of a spec. ``code`` is stable; the message may improve.

    Messages quote the spec; characters that a terminal executes or cannot show are escaped.
    """

    place: Place
    code: str
    message: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "message", visible(self.message))

    def __str__(self) -> str:
        return f"{self.place}: {self.code}: {self.message}"


class SpecError(Exception):
    """A spec that cannot be used; carries every problem, in the order of the files.

    ``partial`` is the edition with stand-ins for what could not be read, or None.
    """

    def __init__(self, problems: Iterable[Problem], partial: Any = None) -> None:
        self.partial = partial
        self.problems = tuple(sorted(set(problems)))
        super().__init__("\n".join(str(problem) for problem in self.problems))


def nearest(given: str, known: Iterable[str]) -> str:
    """Return a hint for a misspelt word: ``; did you mean X?``, or the list of known words."""
    words = sorted(known)
    near = get_close_matches(given, words, n=1, cutoff=0.6)
    if near:
        return f"; did you mean {near[0]}?"
    return f"; known: {', '.join(words)}" if words else ""
