"""At which requests a fault is done: counted, timed and drawn, the same way for the same seed."""

from __future__ import annotations

from random import Random

from cobotwire.errors import UsageError
from cobotwire.sim.faults.exchange import Request
from cobotwire.sim.faults.fault import Fault
from cobotwire.sim.faults.rules import nearest
from cobotwire.table import Table


class Chooser:
    """Chooses for one fault. Faults share no draws: another one beside it changes nothing."""

    def __init__(self, fault: Fault, seed: int, number: int) -> None:
        """``number``: which of the scenario's faults of this kind it is."""
        self.fault = fault
        self.random = Random(f"{seed} {fault.kind} {number}")  # noqa: S311  (repeatable, no secret)
        self._count = 0

    def chooses(self, request: Request) -> bool:
        """Whether the fault is done at this request; to be asked once, in their order."""
        fault = self.fault
        if not self._of_its_kind(request):
            return False
        self._count += 1
        in_turn = self._count % fault.every == 0 and (not fault.nth or self._count in fault.nth)
        until = fault.until_seconds
        in_time = fault.from_seconds <= request.at and (until is None or request.at < until)
        return in_turn and in_time and self.random.random() < fault.probability

    def _of_its_kind(self, request: Request) -> bool:
        names = self.fault.commands
        if names and request.name not in names and request.id not in names:
            return False
        command = request.command
        return {
            "requests": request.id is not None,
            "answers": command is not None and command.answers,
            "acknowledgements": command is not None and command.ack,
            "malformed input": request.id is None,
        }[self.fault.only]


def choosers(faults: tuple[Fault, ...], seed: int) -> list[Chooser]:
    """One for each fault."""
    chosen: list[Chooser] = []
    for fault in faults:
        before = sum(other.fault.kind == fault.kind for other in chosen)
        chosen.append(Chooser(fault, seed, before))
    return chosen


def unknown_command(name: str | int, table: Table) -> str | None:
    """What is wrong with the name of a command; None: nothing, it is an id or the edition's."""
    names = [command.name for command in table.commands]
    if isinstance(name, int) or name in names:
        return None
    return f"a command of edition {table.edition}{nearest(name, names)}"


def check_commands(faults: tuple[Fault, ...], table: Table) -> None:
    """Every command that a fault names must be the edition's.

    Raises:
        UsageError: one is not.
    """
    for fault in faults:
        for name in fault.commands:
            allowed = unknown_command(name, table)
            if allowed is not None:
                raise UsageError(f"{fault.kind}.commands", name, allowed)
