"""Show the results of a run on a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from mutation.running import Verdicts
from mutation.suite import Outcome, by_kind, total


def table(all_verdicts: Iterable[Verdicts]) -> str:
    """Return a row for each edition: what each tester killed + what is excused, of all mutants."""
    cells: dict[str, dict[str, str]] = {}
    for verdicts in all_verdicts:
        tester, _, edition = verdicts.name.partition(", ")
        killed, excused, count = total(verdicts.outcomes)
        cells.setdefault(edition, {})[tester] = f"{killed} + {excused} of {count}"
    testers = ("device", "client with a script", "client without a script", "codec")
    widths = [max(len(tester), 20) for tester in testers]
    rows: list[tuple[str, tuple[str, ...]]] = [("edition", testers)]
    rows += [
        (name, tuple(row.get(tester, "") for tester in testers)) for name, row in cells.items()
    ]
    return "\n".join(
        f"{name:18}" + "".join(f"{cell:>{width + 2}}" for cell, width in zip(row, widths))
        for name, row in rows
    )


def lines(verdicts: Verdicts) -> Iterator[str]:
    """Yield the result of a suite for a terminal."""
    killed, excused, count = total(verdicts.outcomes)
    yield f"{verdicts.name}: {killed} / {count} killed, {excused} unobservable"
    for kind, outcomes in by_kind(verdicts.outcomes):
        some, none, all_of_them = total(outcomes)
        yield f"  {kind:<24}{some:>5} / {all_of_them:<5}{none or '':>5}"
    for outcome in survivors(verdicts):
        yield f"  survived  {outcome.case.id}"
        yield f"            {_why(outcome)}"
    passed = [run for run in verdicts.right_runs if run.passed]
    yield f"  correct subject passed in {len(passed)} of {len(verdicts.right_runs)} runs"
    for run in verdicts.right_runs:
        if not run.passed:
            yield f"  REJECTED  {run.name}: {run.text}"


def survivors(verdicts: Verdicts) -> list[Outcome]:
    """Return the survivors, those without a reason first."""
    left = [outcome for outcome in verdicts.outcomes if not outcome.killed_by]
    return sorted(left, key=lambda outcome: bool(outcome.reason))


def _why(outcome: Outcome) -> str:
    if outcome.crash:
        return f"the tester crashed: {outcome.crash}"
    return outcome.reason or "observable: the tester missed it"
