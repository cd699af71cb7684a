"""When a motion is over: what to request, and when to give up; times are numbers.

A generator yields the next step and is sent how it went. So the blocking and the asyncio client
wait in their own ways, and decide nothing.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import Any, NamedTuple

from cobotwire.protocol.errors import ArmState, MotionTimeout
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Role, Table

# Ten rounds a second of at most two requests: a moving arm replies to 10 to 20 a second.
POLL_SECONDS = 0.1
# How long a motion is waited for by default.
MOTION_SECONDS = 30.0
# An arm that stands still for this long does not continue by itself.
STILL_SECONDS = 1.0
# How long each query after a failed motion may take.
STATE_SECONDS = 0.2


class Query(NamedTuple):
    """Send this request, and wait at most ``longest`` seconds for its reply."""

    request: Request[Any]
    longest: float


class Pause(NamedTuple):
    """Do nothing until then."""

    until: float


class Stop(NamedTuple):
    """Send ``stop``, unless the user of the client chose to leave the arm alone."""


class Outcome(NamedTuple):
    """How a step went: the time after it, and the result; None where no reply came.

    The result of :class:`Stop` is whether it was sent.
    """

    now: float
    result: Any = None


Step = Query | Pause | Stop
Steps = Generator[Step, Outcome, None]


def kind_of(table: Table, label: str) -> int:
    """Return the edition's number for a kind of target, ANGLES or COORDS."""
    kind = table.in_role("reached").request[0].fields[1]
    return kind.choices[kind.labels.index(label)]


def until_reached(
    table: Table, target: Sequence[float], kind: int, limit: float, started: float
) -> Steps:
    """Yield the steps of waiting until the arm is at a target.

    A request without a reply is not an error: the arm is busy. The next round repeats it, until
    the time is over.

    Raises:
        MotionTimeout: the target was not reached within ``limit`` seconds, or the arm has stood
            still for a second and is not there.
    """
    # Their arguments are those of the role, which the type of any request does not say.
    is_reached: Any = table.in_role("reached").request_type
    reached, moving = is_reached(target, kind), table.in_role("moving").request_type()
    now, still_since = started, None
    while True:
        begun = now
        now, is_there = yield Query(reached, _left(started, limit, now))
        if is_there:
            return
        now, is_moving = yield Query(moving, _left(started, limit, now))
        if is_moving is None or is_moving:
            still_since = None
        elif still_since is None:
            still_since = now
        standing = still_since is not None
        stuck = still_since is not None and now - still_since >= STILL_SECONDS
        if stuck or now - started >= limit:
            waited = now - started
            if standing:
                # A stop ends a pause, which would explain why the arm stands still.
                state = yield from _state(table, kind)
                stopped = yield Stop()
            else:
                stopped = yield Stop()
                state = yield from _state(table, kind)
            raise MotionTimeout(tuple(target), waited, standing, bool(stopped.result), state)
        now, _ = yield Pause(max(now, begun + POLL_SECONDS))


def _state(table: Table, kind: int) -> Generator[Step, Outcome, ArmState]:
    """Yield queries for what explains that the arm is not there; return the answers."""
    where: Role = "joints" if kind == kind_of(table, "ANGLES") else "coordinates"
    roles: tuple[Role, ...] = (where, "powered", "paused", "error")
    found: list[Any] = []
    for role in roles:
        command = table.find_role(role)
        if command is None:
            found.append(None)
        else:
            outcome = yield Query(command.request_type(), STATE_SECONDS)
            found.append(outcome.result)
    place, powered, paused, error = found
    position = None if place is None else tuple(place)
    return ArmState(position, powered, paused, error, error_meaning(table))


def error_meaning(table: Table) -> str:
    """Return what the edition says about the numbers of its error register."""
    command = table.find_role("error")
    return "" if command is None else command.reply[0].fields[-1].doc.rstrip(".")


def _left(started: float, limit: float, now: float) -> float:
    """Return the time that is left; a request gets a tenth of a second at least."""
    return max(0.1, started + limit - now)
