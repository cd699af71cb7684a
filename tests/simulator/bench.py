"""A simulated arm, the clock that a test steps, and requests by name."""

from __future__ import annotations

from typing import Any

from cobotwire import codec as codecs
from cobotwire.protocol.messages import Reply
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock


class Bench:
    """An arm of an edition, and its clock."""

    def __init__(self, table: Table, *, powered: bool = True) -> None:
        self.clock = SteppedClock()
        self.arm = SimulatedArm(table, clock=self.clock)
        self._codec = codecs.load(table, "reference")
        if powered:
            self.send("power_on")

    def send(self, name: str, *values: Any) -> bytes:
        return self.arm.receive(self._codec.encode(name, "request", values))

    def query(self, name: str, *values: Any) -> Any:
        """Return what a client's method would return for the reply."""
        reply = self._codec.decode("reply", self.send(name, *values), of=name).typed
        assert isinstance(reply, Reply)
        return reply.result
