"""What a tester's mutants have in common, so that one run counts them all."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol


class Case(NamedTuple):
    """A mutant, by its id within its suite and the kind of its fault."""

    id: str
    kind: str


class Outcome(NamedTuple):
    """What became of a mutant: the rule that found it, or why nobody could find it.

    ``killed_by`` is empty where it survived; ``reason`` is empty where nothing excuses that.
    ``crash`` tells how the tester itself broke on it, which nothing excuses.
    """

    case: Case
    killed_by: str
    reason: str = ""
    crash: str = ""


class Trial(NamedTuple):
    """A run of the tester on the right subject; ``text`` tells what it complained of."""

    name: str
    passed: bool
    text: str = ""


class Suite(Protocol):
    """One tester, one edition: the mutants, and what the tester says of them.

    A suite is made anew in each process, so its cases must be the same each time.
    """

    @property
    def name(self) -> str:
        """What it is called in tables (``device, mycobot280``)."""
        ...

    def cases(self) -> Sequence[Case]:
        """Every mutant."""
        ...

    def judge(self, case: Case) -> Outcome:
        """Let the tester try one mutant."""
        ...

    def trials(self) -> Sequence[str]:
        """The names of the runs that the right subject has to pass."""
        ...

    def accept(self, trial: str) -> Trial:
        """Let the tester try the right subject."""
        ...


def total(outcomes: Sequence[Outcome]) -> tuple[int, int, int]:
    """Killed, excused, and all."""
    killed = sum(bool(outcome.killed_by) for outcome in outcomes)
    excused = sum(bool(not outcome.killed_by and outcome.reason) for outcome in outcomes)
    return killed, excused, len(outcomes)


def by_kind(outcomes: Sequence[Outcome]) -> Iterator[tuple[str, list[Outcome]]]:
    """The outcomes of each kind, in the order of the cases."""
    kinds: dict[str, list[Outcome]] = {}
    for outcome in outcomes:
        kinds.setdefault(outcome.case.kind, []).append(outcome)
    yield from kinds.items()
