"""A suite: one tester, one edition, and the mutants that the tester must kill."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from cobotwire.protocol.table import Table


class Outcome(NamedTuple):
    """The test case that killed a mutant, or the reason why no test case can.

    ``killed_by`` is empty if the mutant survived; ``reason`` is empty if nothing excuses that.
    ``crash`` describes how the tester crashed on it, which nothing excuses.
    """

    id: str
    kind: str
    killed_by: str
    reason: str = ""
    crash: str = ""


class Suite:
    """One tester and one edition: the mutants, and whether the tester kills them.

    Each mutant has the ``kind`` of its fault, and an ``id`` that is unique in its suite. Each
    process makes its own suite, so its mutants must be the same each time.
    """

    # The names of the runs on a correct subject, which must pass.
    right_runs: Sequence[str]

    def __init__(self, table: Table, mutants: Iterable[Any]) -> None:
        self.table = table
        every = list(mutants)
        self.mutants = {mutant.id: mutant for mutant in every}
        assert len(self.mutants) == len(every), "ids are unique"

    def outcome(self, id: str) -> Outcome:
        """Run the tester on a mutant; if it survives, let the oracle give the reason."""
        mutant = self.mutants[id]
        try:
            killer = self.killer(mutant)
            return Outcome(id, mutant.kind, killer, "" if killer else self.reason(mutant))
        except Exception as error:
            # No subject, whatever it does, may crash the tester or the oracle.
            return Outcome(id, mutant.kind, "", "", f"{type(error).__name__}: {error}")

    def killer(self, mutant: Any) -> str:
        """Return the first failure that the tester reports; empty if it reports no failure."""
        raise NotImplementedError

    def reason(self, mutant: Any) -> str:
        """Return why no test case can find a mutant; empty if one could."""
        raise NotImplementedError

    def failure(self, run: str) -> str:
        """Return what the tester reports on a correct subject; empty if it passes."""
        raise NotImplementedError


def missed(outcomes: Iterable[Outcome]) -> list[Outcome]:
    """Return what survived without a reason."""
    return [outcome for outcome in outcomes if not (outcome.killed_by or outcome.reason)]
