"""Describe one of the maker's classes: our edition for it, and the calls that mean the same."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cobotwire.editions import load
from cobotwire.protocol.addresses import find_address, lacks_joints
from cobotwire.protocol.table import Address, Command, Table
from pymycobot_classes import library, peer_on

Arguments = tuple[Any, ...]

# Public names that send nothing to the arm; two of them drive pins of a Raspberry Pi.
LOCAL = frozenset({"close", "gpio_init", "gpio_output", "open", "wait"})


class Call(NamedTuple):
    """A method of the maker's class, and the request of ours that means the same.

    Attributes:
        method: the name of the maker's method.
        theirs: its arguments.
        command: the name of our command; empty if we have none.
        ours: its arguments.
        address: the device that our request goes to; None if frames have no address.
    """

    method: str
    theirs: Arguments
    command: str
    ours: Arguments
    address: str | None = None


@dataclass(frozen=True)
class Robot:
    """One of the maker's classes, and what the comparison needs to know.

    Attributes:
        peer: the name of the class.
        edition: the name of our edition.
        further: editions for methods that ``edition`` has no command for: the class sends the
            requests of other firmware too.
        methods: for our commands, the methods of the class that have another name.
        local: public names of the class whose arguments are not compared.
        lacking: for our commands without a method, the reason.
        not_ours: for methods without a command of ours, the reason.
        own_arguments: for commands, arguments that replace those drawn from the table.
        calls: further calls.
        before: for each name of an address, the arguments that the maker's methods take first.
        without_address: commands with methods that do not take an address.
        opened: makes an object of the class on a port.
    """

    peer: str
    edition: str
    further: tuple[str, ...] = ()
    methods: Mapping[str, str] = field(default_factory=dict)
    local: frozenset[str] = LOCAL
    lacking: Mapping[str, str] = field(default_factory=dict)
    not_ours: Mapping[str, str] = field(default_factory=dict)
    own_arguments: Mapping[str, Sequence[Arguments]] = field(default_factory=dict)
    calls: Sequence[Call] = ()
    before: Mapping[str | None, Arguments] = field(default_factory=lambda: {None: ()})
    without_address: frozenset[str] = frozenset()
    opened: Callable[[str, Any], Any] = peer_on

    @property
    def table(self) -> Table:
        """The table of the edition."""
        return load(self.edition).TABLE

    @property
    def public(self) -> list[str]:
        """The methods of the class that send a frame, in order."""
        names = (name for name in dir(library(self.peer)) if not name.startswith("_"))
        return [name for name in names if name not in self.local]

    def method(self, command: Command) -> str:
        """Return the name of the method for a command."""
        return self.methods.get(command.name, command.name)

    def device(self, address: str | None) -> Address | None:
        """Return what the edition says about an address."""
        return None if address is None else find_address(self.table, address)

    def addresses(self, command: Command) -> list[str | None]:
        """Return the addresses that take a command: they have every joint that it is about."""
        if command.name in self.without_address:
            return list(self.before)[:1]
        table = self.table
        return [a for a in self.before if not lacks_joints(table, self.device(a), command)]

    def on(self, port: Any) -> Any:
        """Return an object of the class on a port."""
        return self.opened(self.peer, port)
