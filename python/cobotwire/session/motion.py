"""When a motion is over: what to request, and when to give up; times are numbers.

A generator yields the next step and is sent how it went. So the blocking and the asyncio client
wait in their own ways, and decide nothing.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import Any, NamedTuple

from cobotwire.protocol.addresses import NOBODY
from cobotwire.protocol.errors import ArmState, MotionTimeout, RequestRefused, UsageError
from cobotwire.protocol.messages import Request
from cobotwire.protocol.roles import COORDS, kinds_of, place_role, reached_query, row_index
from cobotwire.protocol.table import Role, Table
from cobotwire.session.request import EncodedRequest

# Ten rounds a second of at most two requests: a moving arm replies to 10 to 20 a second.
POLL_SECONDS = 0.1
# If the device reports the end of a motion, the queries only make up for an event that was lost.
CONFIRM_SECONDS = 1.0
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


class Listen(NamedTuple):
    """Wait until then, or until the device reports the end of a motion; the result is its event."""

    until: float


class Stop(NamedTuple):
    """Send ``stop``, unless the user of the client chose to leave the arm alone."""


class Outcome(NamedTuple):
    """How a step went: the time after it, and the result; None where no reply came.

    The result of :class:`Stop` is whether it was sent.
    """

    now: float
    result: Any = None


Step = Query | Pause | Listen | Stop
Steps = Generator[Step, Outcome, None]


# How near to a target counts as reached if the edition has no query for it, by unit.
TOLERANCES = {"degree": 0.5, "millimetre": 5.0}
OTHER_TOLERANCE = 1.0
TURN = 360.0


class Goal(NamedTuple):
    """A target that is waited for.

    Attributes:
        target: the numbers of the target.
        place: the role of the query that reports where the arm is, in the same numbers.
        query: reports whether the target is reached, or else where the arm is.
        tolerances: how far each number may be from the target; empty if the arm reports by itself
            whether the target is reached.
        turns: for each number, whether a whole turn makes no difference.
    """

    target: tuple[float, ...]
    place: Role
    query: Request[Any]
    tolerances: tuple[float, ...] = ()
    turns: tuple[bool, ...] = ()

    def is_met(self, result: Any) -> bool:
        """Return whether the result of the query says that the target is reached."""
        if not self.tolerances:
            return bool(result)
        pairs = zip(self.target, result, self.tolerances, self.turns)
        return all(_distance(wish, have, turns) <= most for wish, have, most, turns in pairs)


def _distance(one: float, other: float, turns: bool) -> float:
    distance = abs(one - other)
    return min(distance % TURN, -distance % TURN) if turns else distance


def goal_of(table: Table, target: Sequence[float], kind: int) -> Goal:
    """Return the goal of reaching a target; ``kind`` is one of the edition's ``TargetKind``.

    Raises:
        UsageError: there is no such kind, the target has another number of parts, or the edition
            reports neither whether a target of this kind is reached nor where the arm is.
    """
    kinds = kinds_of(table)
    label = next((label for label, number in kinds.items() if number == kind), None)
    if label is None:
        allowed = ", ".join(f"{name} ({number})" for name, number in kinds.items())
        raise UsageError("kind", kind, allowed)
    place, reached = place_role(label), reached_query(table)
    if reached is not None and label in reached.kinds:
        return Goal(tuple(target), place, reached.request(target, label))
    query = table.in_role(place)
    numbers = query.reply[0].fields[row_index(query.reply[0])].cases[0].numbers
    if len(target) != len(numbers):
        raise UsageError("len(target)", len(target), str(len(numbers)))
    return Goal(
        tuple(target),
        place,
        query.request_type(),
        tuple(TOLERANCES.get(number.unit, OTHER_TOLERANCE) for number in numbers),
        # A joint has ends; the orientation of the end has none.
        tuple(label == COORDS and number.unit == "degree" for number in numbers),
    )


def ack_seconds(request: EncodedRequest) -> float | None:
    """Return how long to wait for the acceptance of a motion; None: the device reports none."""
    command = request.command
    return command.deadline_ms / 1000 if command.ack and request.replier != NOBODY else None


def until_reached(table: Table, goal: Goal, limit: float, started: float) -> Steps:
    """Yield the steps of waiting until the arm is at a target.

    A request without a reply is not an error: the arm is busy. The next round repeats it, until
    the time is over.

    Raises:
        MotionTimeout: the target was not reached within ``limit`` seconds, or the arm has stood
            still for a second and is not there.
        RequestRefused: the device reports that the motion has failed.
    """
    now, still_since, before = started, None, None
    ended = table.find_role("motion ended")
    while True:
        begun = now
        now, found = yield Query(goal.query, _left(started, limit, now))
        if found is not None and goal.is_met(found):
            return
        place = found if goal.tolerances else None
        now, is_moving, before = yield from _moving(table, goal, place, before, limit, started, now)
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
                state = yield from _state(table, goal)
                stopped = yield Stop()
            else:
                stopped = yield Stop()
                state = yield from _state(table, goal)
            raise MotionTimeout(goal.target, waited, standing, bool(stopped.result), state)
        if ended is None:
            now, _ = yield Pause(max(now, begun + POLL_SECONDS))
            continue
        # The event of an earlier motion looks the same, so a query confirms it.
        until = min(max(now, begun + CONFIRM_SECONDS), max(now, started + limit))
        now, event = yield Listen(until)
        refusal = None if event is None else ended.refusal(event.fields)
        if refusal is not None:
            yield Stop()
            what = f"the motion to {list(goal.target)}"
            raise RequestRefused(what, *refusal, b"")


def _moving(
    table: Table, goal: Goal, place: Any, before: Any, limit: float, started: float, now: float
) -> Generator[Step, Outcome, tuple[float, bool | None, Any]]:
    """Yield the query whether the arm moves; else compare where it is with where it was before.

    Args:
        table: the edition.
        goal: what is waited for.
        place: where the arm is; None if it was not asked, or did not reply.
        before: where it was.
        limit: how long the motion is waited for.
        started: when the wait started.
        now: the time.

    Returns:
        The time, whether the arm moves (None: not known), and where it is.
    """
    moving, where = table.find_role("moving"), table.find_role(goal.place)
    if moving is not None:
        now, is_moving = yield Query(moving.request_type(), _left(started, limit, now))
        return now, is_moving, None
    if place is None and where is not None and not goal.tolerances:
        now, place = yield Query(where.request_type(), _left(started, limit, now))
    known = place is not None and before is not None
    return now, place != before if known else None, place


def _state(table: Table, goal: Goal) -> Generator[Step, Outcome, ArmState]:
    """Yield queries for what explains that the arm is not there; return the answers."""
    roles: tuple[Role, ...] = (goal.place, "powered", "paused", "error")
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
    return ArmState(position, powered, paused, error, error_meaning(table, error or 0))


def error_meaning(table: Table, error: int) -> str:
    """Return what the edition says about a number of its error register; empty if nothing."""
    command = table.find_role("error")
    return "" if command is None else command.reply[0].fields[-1].meaning(error)


def _left(started: float, limit: float, now: float) -> float:
    """Return the time that is left; a request gets a tenth of a second at least."""
    return max(0.1, started + limit - now)
