"""The records of a statement, and what it deselects."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from cobotwire.protocol.table import Command, Role, Table

# Every client drives and stops an arm by the commands in these roles: none can be absent.
MANDATORY_ROLES: tuple[Role, ...] = (
    "joints",
    "joint targets",
    "joint target",
    "moving",
    "powered",
    "stop",
)
# Families of commands for equipment that an arm may be without.
EQUIPMENT = ("gripper", "grippers", "hand", "accessories", "network")


class Support(StrEnum):
    """What a statement declares of a command."""

    IMPLEMENTED = "implemented"
    # The device may be without it: silence is no failure.
    OPTIONAL = "optional"
    # The device does not have it: a reply is a failure.
    ABSENT = "absent"


class Acknowledgements(StrEnum):
    """Which changes the device acknowledges, of those that it may."""

    ALL = "all"
    NONE = "none"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Statement:
    """What a maker declares of a device; without an ``edition`` nothing is declared.

    ``firmware`` is as the device reports it; empty: not declared. ``fitted`` says by family of
    commands whether the equipment is there. ``commands`` has the commands that are declared; the
    others are implemented. ``text`` is the whole file.
    """

    edition: str = ""
    maker: str = ""
    product: str = ""
    firmware: str = ""
    acknowledgements: Acknowledgements = Acknowledgements.UNKNOWN
    fitted: Mapping[str, bool] = field(default_factory=dict)
    commands: Mapping[str, Support] = field(default_factory=dict)
    text: str = ""

    @property
    def given(self) -> bool:
        """Whether anything is declared."""
        return bool(self.edition)

    @property
    def optional(self) -> frozenset[str]:
        """The names of the commands that the device may be without."""
        return frozenset(n for n, support in self.commands.items() if support is Support.OPTIONAL)

    def absent(self, table: Table) -> Iterator[Command]:
        """Yield the commands that are declared absent."""
        for command in table.commands:
            if self.lacks(command):
                yield command

    def lacks(self, command: Command) -> bool:
        """Return whether a command is declared absent."""
        return self.commands.get(command.name) is Support.ABSENT

    def deselected(self, command: Command) -> str:
        """Return why a command is not tested; empty: it is."""
        if self.lacks(command):
            return f"The statement declares {command.name} absent."
        if not self.fitted.get(command.family, True):
            return (
                f"The statement declares that there is no equipment of the kind {command.family}."
            )
        return ""


def without(table: Table, lacks: Callable[[Command], object]) -> Table:
    """Return an edition without some commands; no other command refers to one of them."""
    missing = {command.name for command in table.commands if lacks(command)}
    if not missing:
        return table
    kept = [command for command in table.commands if command.name not in missing]
    return table._replace(commands=tuple(_referring(command, missing) for command in kept))


def _referring(command: Command, missing: Container[str]) -> Command:
    """Return a command that refers to none of the missing ones."""
    agreeing = tuple(name for name in command.agrees_with if name not in missing)
    if command.read_by is not None and command.read_by.query in missing:
        return command._replace(read_by=None, agrees_with=agreeing)
    if agreeing != command.agrees_with:
        return command._replace(agrees_with=agreeing)
    return command


def is_mandatory(command: Command) -> bool:
    """Return whether a device without this command cannot conform."""
    return command.role in MANDATORY_ROLES


def equipment(table: Table) -> list[str]:
    """Return the families of an edition that a statement can declare as not fitted."""
    found = {command.family for command in table.commands}
    return [family for family in EQUIPMENT if family in found]
