"""Group results by their cause: the same test case, with reasons that differ only in values."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from cobotwire.conformance.report import Result

# How many characters of a reason are compared: a device may cause very long ones.
MOST = 600
# What may differ between two reasons with one cause: bytes, numbers, arguments.
BYTES = re.compile(r"\b(?:[0-9A-F]{2} ?)+\b")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
ARGUMENTS = re.compile(r"\([^()]*\)|\[[^\[\]]*\]|\{[^{}]*\}")
# The name of a question to a codec, and what its answer held.
QUESTION = re.compile(r"^\S+/\S+: ")
ANSWER = re.compile(r"but the answer was (\S+) .*")


@dataclass(frozen=True, slots=True)
class CauseGroup:
    """Results of one test case with one cause, in the order in which they were found."""

    case: str
    outcome: str
    results: tuple[Result, ...]

    @property
    def commands(self) -> list[str]:
        """The commands, each once."""
        return list(dict.fromkeys(result.command for result in self.results))


def group_by_cause(results: Sequence[Result]) -> list[CauseGroup]:
    """Return the groups, the largest first."""
    found: dict[tuple[str, str, str], list[Result]] = {}
    for result in results:
        key = (result.case, result.outcome, pattern(result))
        found.setdefault(key, []).append(result)
    groups = [CauseGroup(case, outcome, tuple(rs)) for (case, outcome, _), rs in found.items()]
    return sorted(groups, key=lambda group: -len(group.results))


def pattern(result: Result) -> str:
    """Return the reason without what differs between commands and values."""
    text = result.reason[:MOST]
    if result.command:
        text = text.replace(result.command, "COMMAND")
    text = ANSWER.sub(r"but the answer was \1", QUESTION.sub("", text))
    # Inner parentheses first: an argument may be a row, which has parentheses too.
    while text != (text := ARGUMENTS.sub("", text)):
        pass
    for values in (BYTES, NUMBER):
        text = values.sub("", text)
    return " ".join(text.split())
