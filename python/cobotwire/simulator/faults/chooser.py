"""Choose the requests of a fault: by count, by time and by chance, repeatable by a seed."""

from __future__ import annotations

from random import Random

from cobotwire.protocol.errors import UsageError, did_you_mean
from cobotwire.protocol.table import Table
from cobotwire.simulator.faults.exchange import Request
from cobotwire.simulator.faults.fault import Fault


class Chooser:
    """Chooses the requests of one fault.

    Each fault has its own random draws: another fault in the scenario does not change them.
    """

    def __init__(self, fault: Fault, seed: int, number: int) -> None:
        """Seed the draws; ``number`` counts the scenario's faults of this kind, from 0."""
        self.fault = fault
        self.random = Random(f"{seed} {fault.kind} {number}")  # noqa: S311  (repeatable, no secret)
        self._count = 0

    def chooses(self, request: Request) -> bool:
        """Return whether to apply the fault to a request. Call it once for each, in their order."""
        fault = self.fault
        if not self._fits(request):
            return False
        self._count += 1
        first = fault.every if fault.first is None else fault.first
        in_turn = self._count >= first and (self._count - first) % fault.every == 0
        in_turn = in_turn and (not fault.nth or self._count in fault.nth)
        until = fault.until_seconds
        in_time = fault.from_seconds <= request.at and (until is None or request.at < until)
        return in_turn and in_time and self.random.random() < fault.probability

    def _fits(self, request: Request) -> bool:
        names = self.fault.commands
        if names and request.name not in names and request.id not in names:
            return False
        command = request.command
        return {
            "requests": request.id is not None,
            "replies": command is not None and command.requires_reply,
            "acknowledgements": command is not None and command.ack,
            "malformed input": request.id is None,
        }[self.fault.only]


def choosers(faults: tuple[Fault, ...], seed: int) -> list[Chooser]:
    """Return a chooser for each fault."""
    chosen: list[Chooser] = []
    for fault in faults:
        before = sum(other.fault.kind == fault.kind for other in chosen)
        chosen.append(Chooser(fault, seed, before))
    return chosen


def unknown_command(name: str | int, table: Table) -> str | None:
    """Return the correct name for an unknown command.

    None if the edition has it, or it is an id.
    """
    names = [command.name for command in table.commands]
    if isinstance(name, int) or name in names:
        return None
    return f"a command of edition {table.edition}{did_you_mean(name, names)}"


def check_commands(faults: tuple[Fault, ...], table: Table) -> None:
    """Check that the edition has every command that a fault names.

    Raises:
        UsageError: it does not have one of them.
    """
    for fault in faults:
        for name in fault.commands:
            allowed = unknown_command(name, table)
            if allowed is not None:
                raise UsageError(f"{fault.kind}.commands", name, allowed)
