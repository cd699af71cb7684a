"""The records of a statement, what it deselects, and the template for writing one."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import groupby
from typing import Any

from cobotwire.protocol.table import Command, Role, Table

# The version of the format of statements.
FORMAT = 1
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

HEAD = """\
# Implementation conformance statement: what a device has and lacks of the edition {edition}.
# To test a device by it:
#
#   cobotwire --edition {edition} conform device URL --statement FILE
#
statement: {format}
edition: {edition}
maker: ""
product: ""
# The version that {version} reports; empty: it is not compared.
firmware: ""
# Whether changes are acknowledged, where the edition allows it: all, none, unknown.
acknowledgements: unknown
"""
IXIT = """\
# Implementation extra information for testing (IXIT): what a run must know of the device.
# Command-line options override it. Remove the # before each value that you state.
ixit:
  # linger: 4            # milliseconds to listen after a reply
  # workspace: "-30:30"  # degrees in which the arm may move; moving also needs --allow motion
  # max_speed: 20        # percent
  # baudrate: {baudrate}
  # address: ""          # of the device, by its number or name
  # Milliseconds in which a query is replied to, at most those of the edition: they are tested.
  deadlines:
    # {query}: {deadline}
"""
COMMANDS = """\
# implemented: tested. optional: tested, but silence is no failure. absent: not tested, except that
# it must not reply. A command that is left out counts as implemented. Those that are marked as
# mandatory must be implemented.
commands:
"""


class Support(StrEnum):
    """What a statement declares of a command."""

    IMPLEMENTED = "implemented"
    # The device may be without it: silence is no failure.
    OPTIONAL = "optional"
    # The device does not have it: a reply is a failure.
    ABSENT = "absent"


class Acknowledgements(StrEnum):
    """Which changes the device acknowledges, of those that may be acknowledged."""

    ALL = "all"
    NONE = "none"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Statement:
    """What a maker declares of a device; without an ``edition`` nothing is declared.

    ``firmware`` is as the device reports it; empty: not declared. ``fitted`` says by family of
    commands whether the equipment is there. ``commands`` has the commands that are declared; the
    others are implemented. ``ixit`` has options of a run, ``deadlines`` the milliseconds in which
    queries are replied to. ``text`` is the whole file.
    """

    edition: str = ""
    maker: str = ""
    product: str = ""
    firmware: str = ""
    acknowledgements: Acknowledgements = Acknowledgements.UNKNOWN
    fitted: Mapping[str, bool] = field(default_factory=dict)
    commands: Mapping[str, Support] = field(default_factory=dict)
    ixit: Mapping[str, Any] = field(default_factory=dict)
    deadlines: Mapping[str, int] = field(default_factory=dict)
    text: str = ""

    @property
    def is_declared(self) -> bool:
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
        """Return why a command is not tested; empty if it is."""
        if self.lacks(command):
            return f"The statement declares {command.name} absent."
        if not self.fitted.get(command.family, True):
            return (
                f"The statement declares that there is no equipment of the kind {command.family}."
            )
        return ""


def with_deadlines(table: Table, deadlines: Mapping[str, int]) -> Table:
    """Return an edition with the deadlines that a device keeps."""
    kept = (c._replace(deadline_ms=deadlines.get(c.name, c.deadline_ms)) for c in table.commands)
    return table._replace(commands=tuple(kept)) if deadlines else table


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


def statement_template(table: Table) -> str:
    """Return the template for an edition, as YAML; it is a valid statement."""
    version = table.find_role("version")
    name = version.name if version else "the device"
    text = HEAD.format(edition=table.edition, format=FORMAT, version=name)
    families = equipment(table)
    if families:
        text += "# Equipment that is not there is not tested.\nfitted:\n"
        text += "".join(f"  {family}: true\n" for family in families)
    query = next(command for command in table.commands if command.requires_reply)
    text += IXIT.format(baudrate=table.baudrate, query=query.name, deadline=query.deadline_ms)
    return text + COMMANDS + "".join(f"{line}\n" for line in _commands(table))


def _commands(table: Table) -> Iterator[str]:
    usual = [command for command in table.commands if not command.event]
    for family, commands in groupby(usual, key=lambda command: command.family):
        yield f"  # {family}"
        for command in commands:
            yield _line(command)


def _line(command: Command) -> str:
    about = f"mandatory {command.safety}" if is_mandatory(command) else command.safety
    return f"  {command.name}: {Support.IMPLEMENTED}  # {about}"
