"""The suite of the device tester: an edition's mutants, and its correct device."""

from __future__ import annotations

from cobotwire import codec as codecs
from cobotwire.protocol.table import Table
from cobotwire.simulator.arm import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import Noise, Scenario
from cobotwire.simulator.peer import Peer
from mutation.device import device_mutants
from mutation.device.broken import Mutant
from mutation.device.testing import complaints, tested_addresses
from mutation.oracle.reasons import reason
from mutation.suite import Suite

RUNS = 20
# The noise on the line of a healthy arm. Four pieces in seven are servo packets. The class "text"
# is left out, since it includes panics, and a device that panics does not conform.
NOISE = (*4 * ("servo",), "command error", "log", "nuls")
LIGHT_NOISE = Scenario(
    name="light noise",
    faults=(
        Noise(probability=1 / 12, classes=NOISE),
        Noise(probability=1 / 12, classes=NOISE, where="after"),
    ),
)


class DeviceSuite(Suite):
    """Broken devices, and the correct one on a clean line and with light noise."""

    right_runs = tuple(f"{line} {run}" for line in ("clean", "noisy") for run in range(RUNS))

    def __init__(self, table: Table) -> None:
        super().__init__(table, device_mutants(table))
        # Failures that the correct device has too; they do not count. Keyed by the tested command.
        self._groundless: dict[tuple[str, str | None], set[tuple[str, str]]] = {}

    def killer(self, mutant: Mutant) -> str:
        """Return the first failure; empty if every test case passes.

        The test cases of the broken command run first, on a separate device, because they kill
        most mutants; a whole run follows. Each address is run, because some commands exist at one
        address only.
        """
        addresses = tested_addresses(self.table)
        runs = [(mutant.command, address) for address in addresses]
        for only, address in dict.fromkeys((*runs, ("", addresses[0]))):
            clock = SteppedClock()
            device = mutant.make(self.table, clock)
            for found in complaints(self.table, device, clock, only, address):
                if (found.command, found.case) not in self._excuses(only, address):
                    return str(found)
        return ""

    def _excuses(self, only: str, address: str | None) -> set[tuple[str, str]]:
        known = self._groundless.get((only, address))
        if known is None:
            clock = SteppedClock()
            right = SimulatedArm(self.table, clock=clock)
            found = complaints(self.table, right, clock, only, address)
            known = {(complaint.command, complaint.case) for complaint in found}
            self._groundless[only, address] = known
        return known

    def reason(self, mutant: Mutant) -> str:
        """Return why a mutant cannot be distinguished; empty if it can."""
        return reason(self.table, mutant)

    def failure(self, run: str) -> str:
        """Run all test cases on the correct device."""
        line, number = run.split()
        # Each run starts at another time, so that all runs differ.
        clock = SteppedClock(int(number) * 1000.003)
        arm = SimulatedArm(self.table, clock=clock)
        peer: Peer = arm
        if line == "noisy":
            codec = codecs.load(self.table)
            peer = LIGHT_NOISE.wrap(arm, codec, clock=clock, seed=int(number))
        return "; ".join(map(str, complaints(self.table, peer, clock)))
