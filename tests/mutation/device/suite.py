"""The suite of the device tester: an edition's mutants, and its correct device."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire import codec as codecs
from cobotwire.protocol.table import Table
from cobotwire.simulator.arm import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import Noise, Scenario
from cobotwire.simulator.peer import Peer
from mutation.device import device_mutants
from mutation.device.testing import complaints, tested_addresses
from mutation.mutant import Mutant
from mutation.oracle.reasons import reason
from mutation.suite import Case, Outcome, RightRun

RUNS = 20
# The noise on the line of a healthy arm, before one reply in twelve and after one reply in twelve.
# Four pieces in seven are servo packets. The class "text" is left out: it also draws panics, and a
# device that panics does not conform.
NOISE = (*4 * ("servo",), "command error", "log", "nuls")
LIGHT_NOISE = Scenario(
    name="light noise",
    faults=(
        Noise(probability=1 / 12, classes=NOISE),
        Noise(probability=1 / 12, classes=NOISE, where="after"),
    ),
)


class DeviceSuite:
    """See :class:`mutation.suite.Suite`."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._mutants = {mutant.id: mutant for mutant in device_mutants(table)}
        self.name = f"device, {table.edition}"
        # Failures that the correct device has, too; they do not count. Keyed by the tested command.
        self._groundless: dict[tuple[str, str | None], set[tuple[str, str]]] = {}

    def cases(self) -> Sequence[Case]:
        """Return every mutant of the edition's device."""
        return [Case(mutant.id, mutant.kind) for mutant in self._mutants.values()]

    def judge(self, case: Case) -> Outcome:
        """Run the tester until a test case fails; if none fails, let the oracle give the reason."""
        mutant = self._mutants[case.id]
        try:
            found = self._complaint(mutant)
            return Outcome(case, found, "" if found else reason(self._table, mutant))
        except Exception as error:
            # No device, whatever it does, may crash the tester or the oracle.
            return Outcome(case, "", "", f"{type(error).__name__}: {error}")

    def _complaint(self, mutant: Mutant) -> str:
        """Return the first failure; empty if there is none.

        The test cases of the broken command run first, on a separate device, because they kill
        most mutants; a whole run follows. A command may be that of one address.
        """
        addresses = tested_addresses(self._table)
        runs = [(mutant.command, address) for address in addresses]
        for only, address in dict.fromkeys((*runs, ("", addresses[0]))):
            clock = SteppedClock()
            for found in complaints(self._table, mutant.make(clock), clock, only, address):
                if (found.command, found.case) not in self._excuses(only, address):
                    return str(found)
        return ""

    def _excuses(self, only: str, address: str | None) -> set[tuple[str, str]]:
        known = self._groundless.get((only, address))
        if known is None:
            clock = SteppedClock()
            right = SimulatedArm(self._table, clock=clock)
            found = complaints(self._table, right, clock, only, address)
            known = {(complaint.command, complaint.case) for complaint in found}
            self._groundless[only, address] = known
        return known

    def right_runs(self) -> Sequence[str]:
        """Return the names of the runs: on a clean line, and with light noise."""
        return [f"{line} {number}" for line in ("clean", "noisy") for number in range(RUNS)]

    def accept(self, run: str) -> RightRun:
        """Run all test cases on the correct device."""
        line, number = run.split()
        # Each run starts at another time, so that all runs differ.
        clock = SteppedClock(int(number) * 1000.003)
        arm = SimulatedArm(self._table, clock=clock)
        peer: Peer = arm
        if line == "noisy":
            codec = codecs.load(self._table)
            peer = LIGHT_NOISE.wrap(arm, codec, clock=clock, seed=int(number))
        found = list(complaints(self._table, peer, clock))
        return RightRun(run, not found, "; ".join(map(str, found)))
