"""Select the commands of a group by their roles, and by what the spec says that they do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple, TypeVar

from cobotwire.conformance.suite import Selects
from cobotwire.protocol.effects import Effect, Reports, Stores, effect_of
from cobotwire.protocol.table import Command, Role, Table

Kind = TypeVar("Kind", bound=Effect)


class Reporter(NamedTuple):
    """A query that reports a state in a field; ``at`` names the arguments that index the state."""

    state: str
    query: Command
    field: str
    at: tuple[str, ...]


def has_role(*roles: Role) -> Selects:
    """Return a function that selects the commands in one of the roles."""
    return lambda table, command: command.role in roles


def stated_effect(command: Command) -> Effect | None:
    """Return the effect of a command; None if no source states it, so that it is not tested."""
    effect = effect_of(command)
    return None if effect is None or effect.assumed else effect


def does(kind: type[Kind], **wanted: object) -> Callable[[Table, Command], Kind | None]:
    """Return a function that returns the effect of a command if it is of a kind; otherwise None.

    ``wanted`` are values that attributes of the effect must have; True or False: whether the
    attribute must have a value.
    """

    def found(table: Table, command: Command) -> Kind | None:
        effect = stated_effect(command)
        if not isinstance(effect, kind):
            return None
        values = {name: getattr(effect, name) for name in wanted}
        fits = (values[n] == v or (v is bool(values[n])) for n, v in wanted.items())
        return effect if all(fits) else None

    return found


def stored(command: Command) -> tuple[str, ...]:
    """Return the names of what a command stores."""
    effect = stated_effect(command)
    return tuple(effect.values.values()) if isinstance(effect, Stores) else ()


def reported(command: Command) -> tuple[str, ...]:
    """Return the names of what a query reports."""
    effect = stated_effect(command)
    return tuple(effect.values.values()) if isinstance(effect, Reports) else ()


def reporters(table: Table, state: str, *, assumed: bool = False) -> Iterator[Reporter]:
    """Yield the queries that report a state; with ``assumed`` also those that no source states."""
    for command in table.commands:
        effect = effect_of(command) if assumed else stated_effect(command)
        if isinstance(effect, Reports) and not command.event:
            for field, name in effect.values.items():
                if name == state:
                    yield Reporter(state, command, field, effect.at)


def reporter(table: Table, state: str) -> Reporter | None:
    """Return the first query that reports a whole state; None if none does."""
    return next((each for each in reporters(table, state) if not each.at), None)


def first(table: Table, selects: Selects) -> Command | None:
    """Return the first command that is selected; None if none is."""
    return next((command for command in table.commands if selects(table, command)), None)
