"""Show reports side by side: the outcome of each test case on each command, in each report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.conformance.reports.grouped import matrix
from cobotwire.protocol.errors import UsageError


class Row(NamedTuple):
    """A test case on a command, and its outcome in each report; empty: the report has none."""

    clause: int | None
    case: str
    command: str
    outcomes: tuple[str, ...]

    @property
    def differs(self) -> bool:
        """Whether the reports that tested it differ."""
        return len({o for o in self.outcomes if o and not o.startswith(Verdict.NOT_RUN)}) > 1


def side_by_side(reports: Sequence[Report]) -> list[Row]:
    """Return a row for each test case on a command, in the order of the first report that has it.

    Raises:
        UsageError: the reports are about different kinds of subjects.
    """
    kinds = dict.fromkeys(report.kind for report in reports)
    if len(kinds) > 1:
        message = f"the reports are about different kinds of subjects: {', '.join(kinds)}"
        raise UsageError("reports", message=message)
    found = [matrix(report) for report in reports]
    clauses = {case: number for report in reports for case, number in report.clauses.items()}
    return [
        Row(
            clauses.get(case), case, command, tuple(_outcome(m.get((command, case))) for m in found)
        )
        for command, case in dict.fromkeys(key for cells in found for key in cells)
    ]


def _outcome(result: Result | None) -> str:
    return "" if result is None else result.outcome


def counts(rows: Sequence[Row], index: int) -> str:
    """Return how often each verdict is in one report: ``11 pass, 1 fail``; empty if none."""
    verdicts = Counter(
        next(verdict for verdict in Verdict if row.outcomes[index].startswith(verdict))
        for row in rows
        if row.outcomes[index]
    )
    return ", ".join(f"{verdicts[verdict]} {verdict}" for verdict in Verdict if verdict in verdicts)
