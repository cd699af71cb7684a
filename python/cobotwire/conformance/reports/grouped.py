"""Group results: as a matrix of commands and test cases, and by cause."""

from __future__ import annotations

import re
from collections.abc import Iterable

from cobotwire.conformance.report import Report, Result, Verdict

# A cell with several results shows the gravest of them.
GRAVEST = (Verdict.FAIL, Verdict.INCONCLUSIVE, Verdict.NOT_RUN, Verdict.PASS)
# The number of characters of a reason that are compared: a device may cause very long ones.
MOST = 600
# What may differ between two reasons with one cause: bytes, numbers, arguments.
BYTES = re.compile(r"\b(?:[0-9A-F]{2} ?)+\b")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
ARGUMENTS = re.compile(r"\([^()]*\)|\[[^\[\]]*\]|\{[^{}]*\}")
# The name of a question to a codec, and what its answer held.
QUESTION = re.compile(r"^\S+/\S+: ")
ANSWER = re.compile(r"but the answer was (\S+) .*")

# The command, which is empty for the transport as a whole, and the test case.
CellKey = tuple[str, str]


def matrix(report: Report) -> dict[CellKey, Result]:
    """Return the gravest result by command and test case, in the order in which they were tested.

    Of several results with the same verdict, it has the first.
    """
    found: dict[CellKey, Result] = {}
    for result in report.results:
        key = (result.command, result.case)
        before = found.setdefault(key, result)
        if GRAVEST.index(result.verdict) < GRAVEST.index(before.verdict):
            found[key] = result
    return found


def rows(cells: Iterable[CellKey]) -> list[str]:
    """Return the commands of a matrix; the transport comes last."""
    return sorted(dict.fromkeys(command for command, _ in cells), key=lambda name: name == "")


def columns(cells: Iterable[CellKey]) -> list[str]:
    """Return the test cases of a matrix."""
    return list(dict.fromkeys(case for _, case in cells))


def title_of(command: str) -> str:
    """Return a command's name; an empty one means the transport as a whole."""
    return command or "(transport)"


def by_cause(results: Iterable[Result]) -> list[list[Result]]:
    """Group the results of a test case that have the same cause; the largest group comes first."""
    found: dict[tuple[str, str, str], list[Result]] = {}
    for result in results:
        key = (result.case, result.outcome, _pattern(result))
        found.setdefault(key, []).append(result)
    return sorted(found.values(), key=lambda group: -len(group))


def _pattern(result: Result) -> str:
    """Return the reason without what differs between commands and values."""
    text = result.reason[:MOST]
    if result.command:
        text = text.replace(result.command, "COMMAND")
    text = ANSWER.sub(r"but the answer was \1", QUESTION.sub("", text))
    # From the inside out: arguments may be rows, which have parentheses of their own.
    while text != (text := ARGUMENTS.sub("", text)):
        pass
    for values in (BYTES, NUMBER):
        text = values.sub("", text)
    return " ".join(text.split())
