"""The registry of behaviours: what the arm does for each command.

A behaviour takes the arm's state, the time and the typed request, and returns the typed reply. It
serves every edition that has the command: arguments that an edition lacks are None. A behaviour
may return None or leave out optional fields of its reply: the arm then fills in usual legal values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, TypeVar

from cobotwire.protocol.messages import Reply, Request
from cobotwire.simulator.state import ArmState

Behave = Callable[[ArmState, float, Any], Reply[Any] | None]
RequestT = TypeVar("RequestT", bound=Request[Any])
Result = TypeVar("Result", bound=Reply[Any] | None)


class Behaviour(NamedTuple):
    """What the arm does for a command, and the type of the request that the function takes."""

    request_type: type[Request[Any]]
    behave: Behave


BEHAVIOURS: dict[str, Behaviour] = {}


def behaviour(
    request_type: type[RequestT],
) -> Callable[
    [Callable[[ArmState, float, RequestT], Result]], Callable[[ArmState, float, RequestT], Result]
]:
    """Register a function as the behaviour of the command that a request type belongs to."""

    def register(
        behave: Callable[[ArmState, float, RequestT], Result],
    ) -> Callable[[ArmState, float, RequestT], Result]:
        if request_type.command in BEHAVIOURS:
            raise ValueError(f"two behaviours are registered for {request_type.command}")
        BEHAVIOURS[request_type.command] = Behaviour(request_type, behave)
        return behave

    return register


def row(values: Iterable[float]) -> Any:
    """Return a row of a reply: a value for each joint, or for each coordinate.

    Reply types declare the rows of an arm with six joints; other arms have more or fewer values.
    """
    return tuple(values)
