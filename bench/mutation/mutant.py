"""A subject that is broken in one place, as data; and what a suite of them can do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cobotwire.sim.clock import Clock
from cobotwire.sim.peer import Peer


@dataclass(frozen=True, slots=True)
class Mutant:
    """A device that breaks one rule.

    ``kind`` is the class of fault (``scale``), ``command`` and ``field`` where it sits (empty: in
    the line as a whole), ``text`` what the device does wrong. ``make`` gives such a device by a
    clock; each call gives a new one.
    """

    kind: str
    command: str
    field: str
    text: str
    make: Callable[[Clock], Peer]

    @property
    def id(self) -> str:
        """What it is called in tables; no two of a suite share it."""
        place = ".".join(part for part in (self.command, self.field) if part)
        return ": ".join(part for part in (self.kind, place, self.text) if part)
