"""Arrange results as a matrix: a row for each command, a column for each test case."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.conformance.report import Report, Result, Verdict

# A cell with several results shows the first of these.
GRAVEST = (Verdict.FAIL, Verdict.INCONCLUSIVE, Verdict.NOT_RUN, Verdict.PASS)
# The row of test cases about the line as a whole.
LINE = ""

Place = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Cell:
    """The results of one test case on one command."""

    command: str
    case: str
    results: tuple[Result, ...]

    @property
    def gravest(self) -> Result:
        """The first of the results with the gravest verdict."""
        return min(self.results, key=lambda result: GRAVEST.index(result.verdict))

    @property
    def verdict(self) -> Verdict:
        """The gravest verdict."""
        return self.gravest.verdict

    @property
    def outcome(self) -> str:
        """The gravest verdict with its cause."""
        return self.gravest.outcome


def matrix(report: Report) -> dict[Place, Cell]:
    """Return the cells by command and test case, in the order in which they were tested."""
    found: dict[Place, list[Result]] = {}
    for result in report.results:
        found.setdefault((result.command, result.case), []).append(result)
    return {place: Cell(*place, tuple(results)) for place, results in found.items()}


def commands(cells: dict[Place, Cell]) -> list[str]:
    """Return the rows; the row of the line comes last."""
    found = dict.fromkeys(command for command, _ in cells)
    return sorted(found, key=lambda command: command == LINE)


def case_ids(cells: dict[Place, Cell]) -> list[str]:
    """Return the columns."""
    return list(dict.fromkeys(case for _, case in cells))
