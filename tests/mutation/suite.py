"""The interface of the suites, so that one run counts all mutants."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol


class Case(NamedTuple):
    """A mutant, by its id within its suite and the kind of its fault."""

    id: str
    kind: str


class Outcome(NamedTuple):
    """The test case that killed a mutant, or the reason why no test case can.

    ``killed_by`` is empty if the mutant survived; ``reason`` is empty if nothing excuses that.
    ``crash`` describes how the tester crashed on it, which nothing excuses.
    """

    case: Case
    killed_by: str
    reason: str = ""
    crash: str = ""


class RightRun(NamedTuple):
    """A run of the tester on a correct subject; ``text`` lists the failures it reported."""

    name: str
    passed: bool
    text: str = ""


class Suite(Protocol):
    """One tester and one edition: the mutants, and whether the tester kills them.

    Each process makes its own suite, so its cases must be the same each time.
    """

    @property
    def name(self) -> str:
        """The name in tables (``device, mycobot280``)."""
        ...

    def cases(self) -> Sequence[Case]:
        """Return every mutant."""
        ...

    def judge(self, case: Case) -> Outcome:
        """Run the tester on one mutant."""
        ...

    def right_runs(self) -> Sequence[str]:
        """Return the names of the runs on a correct subject, which must pass."""
        ...

    def accept(self, run: str) -> RightRun:
        """Run the tester on a correct subject."""
        ...


def total(outcomes: Sequence[Outcome]) -> tuple[int, int, int]:
    """Return how many are killed, how many are excused, and how many there are."""
    killed = sum(bool(outcome.killed_by) for outcome in outcomes)
    excused = sum(bool(not outcome.killed_by and outcome.reason) for outcome in outcomes)
    return killed, excused, len(outcomes)


def by_kind(outcomes: Sequence[Outcome]) -> Iterator[tuple[str, list[Outcome]]]:
    """Yield the outcomes of each kind, in the order of the cases."""
    kinds: dict[str, list[Outcome]] = {}
    for outcome in outcomes:
        kinds.setdefault(outcome.case.kind, []).append(outcome)
    yield from kinds.items()
