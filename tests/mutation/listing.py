"""Show the results of a run on a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from mutation.running import TESTERS, Verdicts
from mutation.suite import Outcome


class Counts(NamedTuple):
    """How many mutants are killed and excused, and how many there are."""

    killed: int
    excused: int
    every: int

    def __str__(self) -> str:
        return f"{self.killed} + {self.excused} of {self.every}"


def counted(outcomes: Sequence[Outcome]) -> Counts:
    """Count the outcomes of some mutants."""
    killed = sum(bool(outcome.killed_by) for outcome in outcomes)
    excused = sum(bool(not outcome.killed_by and outcome.reason) for outcome in outcomes)
    return Counts(killed, excused, len(outcomes))


def table(all_verdicts: Iterable[Verdicts]) -> str:
    """Return a row for each edition: for each tester the killed and the excused mutants, of all
    mutants."""
    rows: dict[str, dict[str, str]] = {"edition": {tester: tester for tester in TESTERS}}
    for suite, outcomes, _ in all_verdicts:
        rows.setdefault(suite.edition, {})[suite.tester] = str(counted(outcomes))
    return "\n".join(
        f"{name:18}" + "".join(f"{row.get(tester, ''):>25}" for tester in TESTERS)
        for name, row in rows.items()
    )


def lines(verdicts: Verdicts) -> Iterator[str]:
    """Yield the result of a suite for a terminal; the survivors without a reason come first."""
    suite, outcomes, right_runs = verdicts
    yield f"{suite}: {counted(outcomes)} killed + indistinguishable"
    for kind in dict.fromkeys(outcome.kind for outcome in outcomes):
        yield f"  {kind:<24}{counted([each for each in outcomes if each.kind == kind])}"
    survivors = [outcome for outcome in outcomes if not outcome.killed_by]
    for outcome in sorted(survivors, key=lambda outcome: bool(outcome.reason)):
        yield f"  survived  {outcome.id}"
        yield f"            {_why(outcome)}"
    failed = [run for run in right_runs if run.failure]
    passed = len(right_runs) - len(failed)
    yield f"  correct subject passed in {passed} of {len(right_runs)} runs"
    yield from (f"  REJECTED  {run.name}: {run.failure}" for run in failed)


def _why(outcome: Outcome) -> str:
    if outcome.crash:
        return f"the tester crashed: {outcome.crash}"
    return outcome.reason or "observable: the tester missed it"
