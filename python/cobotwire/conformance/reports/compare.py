"""Two reports side by side: what became better, what worse, what is new."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median
from typing import Literal

from cobotwire.conformance.report import Report, Verdict
from cobotwire.conformance.reports.matrix import Cell, Place, matrix
from cobotwire.errors import UsageError

Kind = Literal["worse", "better", "other", "came", "went"]

BAD = (Verdict.FAIL, Verdict.UNSTABLE)
# Reply times vary by themselves; what is told is told as a hint, and never makes a report worse.
NOTABLE_RATIO = 1.5
NOTABLE_SECONDS = 0.001
ENOUGH = 3


@dataclass(frozen=True, slots=True)
class Change:
    """A test whose verdict differs; None: the report has no such test.

    ``worse``: it fails now and did not; or it passed, and is not tested any longer.
    """

    kind: Kind
    command: str
    rule: str
    before: Verdict | None
    after: Verdict | None
    reason: str


@dataclass(frozen=True, slots=True)
class Slower:
    """A query whose median reply time changed notably; seconds."""

    command: str
    before: float
    after: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """What differs between two reports."""

    changes: tuple[Change, ...]
    times: tuple[Slower, ...]

    @property
    def worse(self) -> bool:
        """Whether anything is worse than it was."""
        return any(change.kind == "worse" for change in self.changes)


def compare(before: Report, after: Report) -> Comparison:
    """What differs, in the later report's order; what it lacks comes last.

    Raises:
        UsageError: the two are about different kinds of things.
    """
    if before.kind != after.kind:
        raise UsageError("kind", after.kind, f"{before.kind}, as the report to compare with")
    old, new = matrix(before), matrix(after)
    places = dict.fromkeys([*new, *old])
    found = (_change(place, old.get(place), new.get(place)) for place in places)
    return Comparison(tuple(filter(None, found)), tuple(_times(before, after)))


def _change(place: Place, old: Cell | None, new: Cell | None) -> Change | None:
    before = None if old is None else old.verdict
    after = None if new is None else new.verdict
    if before == after:
        return None
    shown = new or old
    assert shown is not None, "a place has a cell in one of the two"
    reason = next(r.reason for r in shown.results if r.verdict is shown.verdict)
    return Change(_kind(before, after), *place, before, after, reason)


def _kind(before: Verdict | None, after: Verdict | None) -> Kind:
    if after in BAD:
        return "other" if before in BAD else "worse"
    if before is Verdict.PASS:
        return "worse"
    if before in BAD and after is Verdict.PASS:
        return "better"
    if before is None:
        return "came"
    return "went" if after is None else "other"


def _times(before: Report, after: Report) -> list[Slower]:
    found = []
    for command, seconds in after.reply_seconds.items():
        earlier = before.reply_seconds.get(command, [])
        if min(len(earlier), len(seconds)) >= ENOUGH:
            old, new = median(earlier), median(seconds)
            low, high = sorted((old, new))
            if high - low >= NOTABLE_SECONDS and high >= low * NOTABLE_RATIO:
                found.append(Slower(command, old, new))
    return found
