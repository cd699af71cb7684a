"""The options of a run on a client, as a report keeps them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from cobotwire.conformance.client.delivery import faulty_replies
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator.faults import Scenario

# The options that are not text.
KINDS: Mapping[str, type] = {"every": int, "delay": float, "patience": float}


@dataclass(frozen=True, slots=True)
class ClientOptions:
    """What a caller chooses for a run; ``delay`` and ``patience`` are in milliseconds.

    ``script`` is the text of the calls that the client makes, and ``script_name`` the name of its
    file; empty: they are not known.
    """

    misbehave: str = ""
    every: int = 3
    delay: float = 8.0
    patience: float = 30.0
    no_acks: bool = False
    script: str = ""
    script_name: str = ""

    @classmethod
    def of_report(cls, options: Mapping[str, Any]) -> ClientOptions:
        """Return the options that a report keeps.

        Raises:
            UsageError: an option is unknown or illegible.
        """
        known = {field.name for field in fields(cls)}
        if set(options) - known:
            message = "the report does not hold the options of a run on a client"
            raise UsageError("report", message=message)
        try:
            given = {name: KINDS.get(name, str)(text) for name, text in options.items()}
        except (TypeError, ValueError) as error:
            raise UsageError("report", message=f"its options: {error}") from error
        return cls(**given | ({"no_acks": True} if given.get("no_acks") else {}))

    def for_report(self) -> dict[str, str]:
        """Return the options that differ from their defaults."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        usual = {field.name: field.default for field in fields(self)}
        return {name: str(value) for name, value in given.items() if value != usual[name]}

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
