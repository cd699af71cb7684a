"""Compare two reports: what became better, what became worse, what is new."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median
from typing import Literal

from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.conformance.reports.grouped import CellKey, matrix
from cobotwire.protocol.errors import UsageError

Kind = Literal["worse", "better", "other", "added", "removed"]

# Reply times vary by themselves: a difference is only a hint and never makes a report worse.
NOTABLE_RATIO = 1.5
NOTABLE_SECONDS = 0.001
ENOUGH = 3


@dataclass(frozen=True, slots=True)
class Change:
    """A test case with another outcome on a command; None: the report has no result for it.

    ``worse``: it fails now and did not, or it passed and no longer does.
    """

    kind: Kind
    command: str
    case: str
    before: str | None
    after: str | None
    reason: str


@dataclass(frozen=True, slots=True)
class ChangedTime:
    """The median reply times to a query, in seconds, if they differ notably."""

    command: str
    before: float
    after: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """The differences between two reports."""

    changes: tuple[Change, ...]
    times: tuple[ChangedTime, ...]

    @property
    def worse(self) -> bool:
        """Whether anything became worse."""
        return any(change.kind == "worse" for change in self.changes)


def compare(before: Report, after: Report) -> Comparison:
    """Return the differences in the order of the later report; what it lacks comes last.

    Raises:
        UsageError: the reports are about different kinds of subjects.
    """
    if before.kind != after.kind:
        message = f"reports of two kinds, {before.kind} and {after.kind}, cannot be compared"
        raise UsageError("kind", message=message)
    old, new = matrix(before), matrix(after)
    keys = dict.fromkeys([*new, *old])
    found = (_change(key, old.get(key), new.get(key)) for key in keys)
    return Comparison(tuple(filter(None, found)), tuple(_times(before, after)))


def _change(key: CellKey, old: Result | None, new: Result | None) -> Change | None:
    before = None if old is None else old.outcome
    after = None if new is None else new.outcome
    if before == after:
        return None
    shown = new or old
    assert shown is not None, "a test case on a command has a result in one of the two"
    return Change(_kind(old, new), *key, before, after, shown.reason)


def _kind(old: Result | None, new: Result | None) -> Kind:
    before = None if old is None else old.verdict
    after = None if new is None else new.verdict
    if after is Verdict.FAIL:
        return "other" if before is Verdict.FAIL else "worse"
    if before is Verdict.PASS:
        return "worse"
    if before is Verdict.FAIL and after is Verdict.PASS:
        return "better"
    if before is None:
        return "added"
    return "removed" if after is None else "other"


def _times(before: Report, after: Report) -> list[ChangedTime]:
    found = []
    for command, seconds in after.reply_seconds.items():
        earlier = before.reply_seconds.get(command, [])
        if min(len(earlier), len(seconds)) >= ENOUGH:
            old, new = median(earlier), median(seconds)
            low, high = sorted((old, new))
            if high - low >= NOTABLE_SECONDS and high >= low * NOTABLE_RATIO:
                found.append(ChangedTime(command, old, new))
    return found
