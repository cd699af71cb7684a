"""A device with one fault, as data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cobotwire.simulator.clock import Clock
from cobotwire.simulator.peer import Peer


@dataclass(frozen=True, slots=True)
class Mutant:
    """A device with one fault.

    ``kind`` is the class of fault (``scale``). ``command`` and ``field`` are its place; both are
    empty if it concerns the whole line. ``text`` is what the device does wrong. ``make`` returns a
    new device with the fault, which uses the given clock.
    """

    kind: str
    command: str
    field: str
    text: str
    make: Callable[[Clock], Peer]

    @property
    def id(self) -> str:
        """The name in tables, unique within a suite."""
        place = ".".join(part for part in (self.command, self.field) if part)
        return ": ".join(part for part in (self.kind, place, self.text) if part)
