"""The registry of behaviours: what the arm does for each command.

A behaviour takes the arm's state, the time and the typed request, and returns the typed reply. It
serves every edition that has the command: arguments that an edition lacks are None. A behaviour
may return None or leave out optional fields of its reply: the arm then fills in usual legal values.
It may also state how many data bytes the reply has (:class:`Sized`).
Most commands need none: the arm does what the edition states
(:mod:`cobotwire.simulator.effects`). A behaviour is for physics, and for what only one robot does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any, NamedTuple, TypeVar

from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Command, Direction, Table
from cobotwire.simulator.replies import Unanswerable as Unanswerable
from cobotwire.simulator.state import ArmState


class Sized(NamedTuple):
    """A reply with its number of data bytes, if variants with the same fields differ in it."""

    reply: Reply[Any]
    size: int


Behave = Callable[[ArmState, float, Any], Reply[Any] | Sized | None]
RequestT = TypeVar("RequestT", bound=Request[Any])
Result = TypeVar("Result", bound=Reply[Any] | Sized | None)


class Behaviour(NamedTuple):
    """What the arm does for a command, and the type of the request that the function takes."""

    request_type: type[Request[Any]]
    behave: Behave

    def fits(self, command: Command) -> bool:
        """Return whether the types have every field of an edition's command."""
        reply_type = self.request_type.reply_type
        replied: tuple[str, ...] = () if reply_type is None else reply_type.__match_args__
        known: tuple[str, ...] = self.request_type.__match_args__
        return _names(command, "request") <= set(known) and (
            not command.requires_reply or _names(command, "reply") <= {*known, *replied}
        )


def _names(command: Command, direction: Direction) -> set[str]:
    """Return the names of a message's fields, except for constants."""
    fields = (field for variant in command.variants(direction) for field in variant.fields)
    return {field.name for field in fields if len(field.choices) != 1 or field.labels}


Value = TypeVar("Value")


class Behaviours(dict[str, Behaviour]):
    """Behaviours by the name of their command.

    A package of your own has its own registry, so that its commands cannot be mistaken for those of
    another protocol::

        behaviours = Behaviours()


        @behaviours.behaviour(messages.SetMode)
        def set_mode(arm, now, request):
            arm.kept["mode"] = request.mode
    """

    def behaviour(
        self, request_type: type[RequestT]
    ) -> Callable[
        [Callable[[ArmState, float, RequestT], Result]],
        Callable[[ArmState, float, RequestT], Result],
    ]:
        """Register a function as the behaviour of the command that a request type belongs to."""

        def register(
            behave: Callable[[ArmState, float, RequestT], Result],
        ) -> Callable[[ArmState, float, RequestT], Result]:
            if request_type.command in self:
                raise ValueError(f"two behaviours are registered for {request_type.command}")
            self[request_type.command] = Behaviour(request_type, behave)
            return behave

        return register

    def query(
        self,
        request_type: type[Request[Value]],
        value: Callable[[ArmState, float, Any], Value | None],
    ) -> None:
        """Let a command reply with a value that ``value`` returns; None: the arm fills it in."""

        @self.behaviour(request_type)
        def reply(arm: ArmState, now: float, request: Request[Value]) -> Reply[Value] | None:
            found = value(arm, now, request)
            # Type checkers do not know the fields of a query's reply: the first one is the value.
            reply_type: Any = request_type.reply_type
            return None if found is None else reply_type(found)


# The behaviours that come with cobotwire.
BEHAVIOURS = Behaviours()
behaviour, query = BEHAVIOURS.behaviour, BEHAVIOURS.query


# Behaviours of editions that differ from the 280, by the name of the edition; they come first.
_FAMILIES: dict[str, Behaviours] = {}
# The module of this package that registers the behaviours of an edition.
HOMES = {"mercury_a1": "mercury", "mybuddy": "limbs"}


def family(edition: str, behaviours: Behaviours) -> Behaviours:
    """Return a registry for an edition and its deltas; its behaviours precede those of the 280."""
    _FAMILIES[edition] = behaviours
    return behaviours


def own(table: Table, command: Command) -> Behaviour | None:
    """Return the behaviour of cobotwire for a command, or None.

    A command with the same name but other fields has none: the behaviour does not know them.
    """
    lineage = (table.edition, *table.bases)
    for home in filter(None, map(HOMES.get, lineage)):
        import_module(f"cobotwire.simulator.behaviour.{home}")
    families = (_FAMILIES[each] for each in lineage if each in _FAMILIES)
    for behaviours in (*families, BEHAVIOURS):
        found = behaviours.get(command.name)
        if found is not None and found.fits(command):
            return found
    return None


def row(values: Iterable[float] | None) -> Any:
    """Return a row of a reply: a value for each joint, or for each coordinate; None for None.

    Reply types declare the rows of an arm with six joints; other arms have more or fewer values.
    """
    return None if values is None else tuple(values)
