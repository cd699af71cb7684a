"""Waiting for the end of a motion: what to ask, and when to give up; times are numbers.

A generator yields what to do next, and is sent how that went. So the blocking and the asyncio
driver wait in their own ways and decide nothing.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import Any, NamedTuple

from cobotwire.errors import MotionTimeout
from cobotwire.table import Command, Table

# Ten rounds of two questions at most: an arm that moves answers 10 to 20 a second.
POLL_SECONDS = 0.1
# How long a motion is waited for, unless the caller says otherwise.
MOTION_SECONDS = 30.0
# An arm that stands still for so long will not go on by itself.
STILL_SECONDS = 1.0


class Ask(NamedTuple):
    """Ask this, and wait ``longest`` seconds at most."""

    name: str
    values: tuple[Any, ...]
    longest: float


class Pause(NamedTuple):
    """Do nothing until then."""

    until: float


class Went(NamedTuple):
    """How a step went: the time after it; the reply's fields, None where none came."""

    now: float
    fields: dict[str, Any] | None = None


Steps = Generator[Ask | Pause, Went, None]


def kind_of(table: Table, label: str) -> int:
    """The number by which the edition calls a kind of target, ANGLES or COORDS."""
    kind = table.in_role("reached").request[0].fields[1]
    return kind.choices[kind.labels.index(label)]


def until_reached(
    table: Table, target: Sequence[float], kind: int, limit: float, started: float
) -> Steps:
    """The steps of waiting until the arm is at a target.

    A question that stays unanswered is no failure: the arm is busy. It is asked again in the next
    round, until the time is over.

    Raises:
        MotionTimeout: the target was not reached within ``limit`` seconds, or the arm has stood
            still for a second and is not there.
    """
    reached, moving = table.in_role("reached"), table.in_role("moving")
    now, still_since = started, None
    while True:
        begun = now
        now, answer = yield Ask(reached.name, (target, kind), _left(started, limit, now))
        if _yes(reached, answer):
            return
        now, answer = yield Ask(moving.name, (), _left(started, limit, now))
        if answer is None or _yes(moving, answer):
            still_since = None
        elif still_since is None:
            still_since = now
        standing = still_since is not None
        stuck = still_since is not None and now - still_since >= STILL_SECONDS
        if stuck or now - started >= limit:
            raise MotionTimeout(tuple(target), now - started, standing)
        now, _ = yield Pause(max(now, begun + POLL_SECONDS))


def _left(started: float, limit: float, now: float) -> float:
    """What is left of the time; a question gets a tenth of a second at least."""
    return max(0.1, started + limit - now)


def _yes(command: Command, fields: dict[str, Any] | None) -> bool:
    """What the one flag of a reply says."""
    return fields is not None and bool(fields[command.reply[0].fields[0].name])
