"""The device tester's suite: mutants of an edition, and its right device on two sorts of line."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.table import Table
from mutation.device import device_mutants
from mutation.device.noise import NoisyLine
from mutation.device.testing import complaints
from mutation.mutant import Mutant
from mutation.oracle.reasons import reason
from mutation.suite import Case, Outcome, Trial

RUNS = 20


class DeviceSuite:
    """See :class:`mutation.suite.Suite`."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._mutants = {mutant.id: mutant for mutant in device_mutants(table)}
        self.name = f"device, {table.edition}"
        # What the right device is told as well tells it from nobody: by the command that is tried.
        self._groundless: dict[str, set[tuple[str, str]]] = {}

    def cases(self) -> Sequence[Case]:
        """Every mutant of the edition's device."""
        return [Case(mutant.id, mutant.kind) for mutant in self._mutants.values()]

    def judge(self, case: Case) -> Outcome:
        """Run the tester until it complains; where it does not, ask the oracle why."""
        mutant = self._mutants[case.id]
        try:
            found = self._complaint(mutant)
            return Outcome(case, found, "" if found else reason(self._table, mutant))
        except Exception as error:
            # Whatever it is: neither tester nor oracle may break on a device.
            return Outcome(case, "", "", f"{type(error).__name__}: {error}")

    def _complaint(self, mutant: Mutant) -> str:
        """The first thing that the tester finds; empty: nothing.

        The tests of the broken command go first, on a device of their own, since most mutants are
        found by them; then comes a whole run.
        """
        for only in dict.fromkeys((mutant.command, "")):
            clock = SteppedClock()
            for found in complaints(self._table, mutant.make(clock), clock, only):
                if (found.command, found.rule) not in self._excuses(only):
                    return str(found)
        return ""

    def _excuses(self, only: str) -> set[tuple[str, str]]:
        if only not in self._groundless:
            clock = SteppedClock()
            right = SimulatedArm(self._table, clock=clock)
            found = complaints(self._table, right, clock, only)
            self._groundless[only] = {(complaint.command, complaint.rule) for complaint in found}
        return self._groundless[only]

    def trials(self) -> Sequence[str]:
        """Each run on a line of its own: clean, and with light noise."""
        return [f"{line} {number}" for line in ("clean", "noisy") for number in range(RUNS)]

    def accept(self, trial: str) -> Trial:
        """Run the tester on the right device, to its end."""
        line, number = trial.split()
        # Each run begins at another time, so that no two are the same.
        clock = SteppedClock(int(number) * 1000.003)
        arm = SimulatedArm(self._table, clock=clock)
        peer = NoisyLine(arm, int(number)) if line == "noisy" else arm
        found = list(complaints(self._table, peer, clock))
        return Trial(trial, not found, "; ".join(map(str, found)))
