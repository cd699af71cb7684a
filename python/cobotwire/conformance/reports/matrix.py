"""Results as a matrix: a row a command, a column a rule."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.conformance.report import Report, Result, Verdict

# What a cell with several results shows: the one to look at first.
GRAVEST = (
    Verdict.FAIL,
    Verdict.UNSTABLE,
    Verdict.NOT_SUPPORTED,
    Verdict.NOT_ALLOWED,
    Verdict.PASS,
)
# The row of rules that are about the line and no command.
LINE = ""

Place = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Cell:
    """The results of one rule on one command."""

    command: str
    rule: str
    results: tuple[Result, ...]

    @property
    def verdict(self) -> Verdict:
        """The gravest."""
        return min((result.verdict for result in self.results), key=GRAVEST.index)


def matrix(report: Report) -> dict[Place, Cell]:
    """The cells by command and rule, in the order in which they were tested."""
    found: dict[Place, list[Result]] = {}
    for result in report.results:
        found.setdefault((result.command, result.rule), []).append(result)
    return {place: Cell(*place, tuple(results)) for place, results in found.items()}


def commands(cells: dict[Place, Cell]) -> list[str]:
    """The rows; the line's comes last."""
    found = dict.fromkeys(command for command, _ in cells)
    return sorted(found, key=lambda command: command == LINE)


def rules(cells: dict[Place, Cell]) -> list[str]:
    """The columns."""
    return list(dict.fromkeys(rule for _, rule in cells))
