"""The options of a run on a client, as a report keeps them."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.conformance.client.delivery import faulty_replies
from cobotwire.conformance.options import Options
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator.faults import Scenario


@dataclass(frozen=True, slots=True)
class ClientOptions(Options):
    """What a caller chooses for a run; ``delay`` and ``patience`` are in milliseconds.

    ``script`` is the text of the calls that the client makes, and ``script_name`` the name of its
    file; empty: they are not known.
    """

    kind = "client"

    misbehave: str = ""
    every: int = 3
    delay: float = 8.0
    patience: float = 30.0
    no_acks: bool = False
    script: str = ""
    script_name: str = ""

    def scenario(self) -> Scenario:
        """Return how replies are delivered.

        Raises:
            UsageError: a time is too long, or there is no such fault.
        """
        for name in ("delay", "patience"):
            if not 0 <= getattr(self, name) <= 60_000:
                raise UsageError(name, getattr(self, name), "0..60000 milliseconds")
        faults = [word for word in self.misbehave.split(",") if word]
        return faulty_replies(self.delay / 1000, faults, self.every)
