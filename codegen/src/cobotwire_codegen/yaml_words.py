"""Explains mistakes in YAML files: what is wrong, where, and what to do."""

from __future__ import annotations

import re
from dataclasses import dataclass

# Line and column, from 0, as the YAML library counts.
Spot = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Mistake:
    """A report of the YAML library: two texts, where a construct begins, and where it fails."""

    context: str
    problem: str
    began: Spot | None
    failed: Spot | None


_CLOSED = re.compile(r"expected ',' or '(.)', but got '?(.*?)'?\Z")
_TOKEN = re.compile(r"found character (.*) that cannot start any token")
_ALIAS = re.compile(r"found undefined alias '(.*)'")
_OPENING = {"]": "[", "}": "{"}


def explained(mistake: Mistake, quote: tuple[Spot, Spot] | None) -> tuple[Spot, str]:
    """Return the place to look at, and what is wrong there.

    ``quote`` is the start and end of a quoted text of several lines that ends right before the
    mistake. Probably the first quote of that text was never closed.
    """
    began, failed = mistake.began, mistake.failed or mistake.began or (0, 0)
    if "quoted scalar" in mistake.context and "end of stream" in mistake.problem and began:
        return began, "the quote that is opened here is never closed"
    if quote is not None:
        line = quote[1][0] + 1
        return quote[0], f"the quote that is opened here is closed only in line {line}; close it"
    return _of_structure(mistake, began or failed, failed)


def _of_structure(mistake: Mistake, began: Spot, failed: Spot) -> tuple[Spot, str]:
    problem = mistake.problem
    closed = _CLOSED.match(problem)
    if closed:
        where = f"line {failed[0] + 1}, column {failed[1] + 1}"
        return began, (
            f"the {_OPENING.get(closed[1], 'bracket')} that is opened here is not closed: {where} "
            f"has {closed[2]} instead of , or {closed[1]}"
        )
    if "mapping values are not allowed" in problem:
        return failed, (
            "a : is not allowed here; quote a text that contains it, or indent the key like the "
            "other keys of its mapping"
        )
    if "expected <block end>" in problem or "did not find expected" in problem:
        return failed, (
            f"this does not continue what starts in line {began[0] + 1}; indent it like the "
            "lines that it belongs to"
        )
    if "could not find expected ':'" in problem:
        return began, "a key must be followed by a : on the same line"
    if "sequence entries are not allowed" in problem:
        return failed, "a - is not allowed here; start the list on a line of its own"
    return failed, _of_words(problem)


def _of_words(problem: str) -> str:
    token, alias = _TOKEN.match(problem), _ALIAS.match(problem)
    if token:
        what = "a tab" if "\\t" in token[1] else token[1]
        todo = "indent with spaces" if "\\t" in token[1] else "quote the text"
        return f"{what} cannot start a value; {todo}"
    if alias:
        return f"there is no anchor &{alias[1]} above this alias"
    if "another document" in problem:
        return "a file holds one document; remove this line"
    return problem or "this is not YAML"
