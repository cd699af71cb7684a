"""Find out whether a motion has ended: what to query, and when to give up; times are numbers.

A generator yields the next step and receives its outcome. The blocking and the asyncio client only
carry out the steps.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Sequence
from math import inf
from typing import Any, NamedTuple, NoReturn

from cobotwire.protocol.addresses import NOBODY
from cobotwire.protocol.errors import ArmState, MotionTimeout, RequestRefused, UsageError
from cobotwire.protocol.messages import Event, Request
from cobotwire.protocol.numbers import Number
from cobotwire.protocol.roles import COORDS, kinds_of, position_role, reached_query, row_index
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.session.request import EncodedRequest

# A moving arm replies to 10 to 20 queries a second. A wait sends at most 12 queries in any second:
# these, and two repeats of a query whose reply is lost.
MOST_QUERIES = 10
# Near the end, the interval between two queries is this, divided by the number of queries that
# MOST_QUERIES still allows in the same second.
SPACING_SECONDS = 0.1
# The position is read a second time after this time; each later interval is twice the one before.
FIRST_SECONDS = 0.05
# The longest time between two readings of the position. If the device reports the end of a motion,
# the queries only make up for an event that was lost.
READING_SECONDS, CONFIRM_SECONDS = 0.5, 1.0
# Near the end the position is read again after this time.
AGAIN_SECONDS = 0.15
# How long to wait for the event of the end before the arm is queried.
EVENT_SECONDS = 0.15
# An arm that approaches its target by fewer tolerances a second may stand still.
SLOWEST = 2.0
# An arm that stands still for this long does not continue by itself.
STILL_SECONDS = 1.0
# How long each query after a failed motion may take.
STATE_SECONDS = 0.2
# A query is repeated within its time, at the earliest after this time.
REPEAT_SECONDS = 0.1


class Query(NamedTuple):
    """Send this request, and wait at most ``longest`` seconds for its reply.

    If it is ``optional``, a reply that the edition does not allow counts as no reply.
    """

    request: Request[Any]
    longest: float
    optional: bool = False


class Listen(NamedTuple):
    """Wait until the time ``until``, or until the device sends a sign of the end of a motion.

    The result is the event of the end, or True for the acknowledgement of a motion: some firmware
    acknowledges a motion when it ends.
    """

    until: float


class Stop(NamedTuple):
    """Send ``stop``, unless the user of the client chose to leave the arm alone."""


class Outcome(NamedTuple):
    """The outcome of a step: the time after it, and the result; None if no reply came.

    The result of :class:`Stop` is whether it was sent.
    """

    now: float
    result: Any = None


Step = Query | Listen | Stop
Steps = Generator[Step, Outcome, None]


# How near to a target counts as reached if the edition has no query for it, by unit.
TOLERANCES = {"degree": 0.5, "millimetre": 5.0}
OTHER_TOLERANCE = 1.0
TURN = 360.0


class Goal(NamedTuple):
    """A target that is waited for.

    Attributes:
        target: the numbers of the target.
        position: the role of the query that reports where the arm is, in the same numbers.
        query: reports whether the target is reached, or else where the arm is.
        decides: whether the arm reports by itself whether the target is reached.
        tolerances: how far each number may be from the target if the arm does not report this;
            empty if the edition does not report where the arm is.
        turns: for each number, whether a whole turn makes no difference.
    """

    target: tuple[float, ...]
    position: Role
    query: Request[Any]
    decides: bool
    tolerances: tuple[float, ...]
    turns: tuple[bool, ...]

    def is_met(self, result: Any) -> bool:
        """Return whether the result of the query says that the target is reached."""
        return bool(result) if self.decides else self.distance(result) <= 1

    def distance(self, position: Sequence[float]) -> float:
        """Return the largest distance of a number from its target, in tolerances."""
        numbers = zip(self.target, position, self.tolerances, self.turns)
        return max(_distance(wish, have, turns) / most for wish, have, most, turns in numbers)


def _distance(one: float, other: float, turns: bool) -> float:
    distance = abs(one - other)
    return min(distance % TURN, -distance % TURN) if turns else distance


def goal_of(table: Table, target: Sequence[float], kind: int) -> Goal:
    """Return the goal of reaching a target; ``kind`` is one of the edition's ``TargetKind``.

    Raises:
        UsageError: there is no such kind, the target has a wrong number of values, or the edition
            reports neither whether a target of this kind is reached nor where the arm is.
    """
    kinds = kinds_of(table)
    label = next((label for label, number in kinds.items() if number == kind), None)
    if label is None:
        allowed = ", ".join(f"{name} ({number})" for name, number in kinds.items())
        raise UsageError("kind", kind, allowed)
    position, reached = position_role(label), reached_query(table)
    decides = reached is not None and label in reached.kinds
    where = table.find_role(position) if decides else table.in_role(position)
    numbers = () if where is None else _numbers(where)
    if reached is not None and decides:
        query = reached.request(target, label)
    else:
        if len(target) != len(numbers):
            raise UsageError("len(target)", len(target), str(len(numbers)))
        query = table.in_role(position).request_type()
    tolerances = tuple(TOLERANCES.get(number.unit, OTHER_TOLERANCE) for number in numbers)
    # A joint has a limited range; the orientation of the flange has none.
    turns = tuple(label == COORDS and number.unit == "degree" for number in numbers)
    return Goal(tuple(target), position, query, decides, tolerances, turns)


def _numbers(where: Command) -> tuple[Number, ...]:
    """Return the numbers that the query reports."""
    reply = where.reply[0]
    return reply.fields[row_index(reply)].cases[0].numbers


def ack_seconds(request: EncodedRequest) -> float | None:
    """Return how long to wait for the acceptance of a motion; None: the device reports none."""
    command = request.command
    return command.deadline_ms / 1000 if command.ack and request.replier != NOBODY else None


def until_reached(table: Table, goal: Goal, limit: float, started: float) -> Steps:
    """Yield the steps of waiting until the arm is at a target.

    Two readings of the position show when the arm will arrive. Until shortly before that the
    position is queried rarely; then queries follow each other quickly. An event or
    acknowledgement of the end may belong to an earlier motion, so a query confirms it.

    A query without a reply is not an error: the arm is busy. It is repeated until the time is over.

    Raises:
        MotionTimeout: the target was not reached within ``limit`` seconds, or the arm has stood
            still for a second and is not there.
        RequestRefused: the device reports that the motion has failed.
    """
    return _Wait(table, goal, limit, started).steps()


class _Wait:
    """The state of a wait: the motion as far as it was observed, and the times of the queries."""

    def __init__(self, table: Table, goal: Goal, limit: float, started: float) -> None:
        self._table, self._goal = table, goal
        self._started, self._ends = started, started + limit
        self._now = started
        self._ended, self._moving = table.find_role("motion ended"), table.find_role("moving")
        # None: nothing reports where the arm is.
        self._where = table.find_role(goal.position) if goal.tolerances else None
        # The time and the result of the last reading of the position.
        self._before: tuple[float, Any] | None = None
        self._still_since: float | None = None
        # When the arm may be there at the earliest, and when its position is read again.
        self._due = self._read_at = started
        self._sent: deque[float] = deque()

    def steps(self) -> Steps:
        """Yield the steps of the wait."""
        goal, signed = self._goal, False
        while True:
            near, found = signed or self._now >= self._due, None
            if near or not goal.decides:
                found = yield from self._query(goal.query, optional=False)
                if found is not None and goal.is_met(found):
                    return
            if not goal.decides or not near or self._now >= self._read_at:
                yield from self._predict(None if goal.decides else found, near)
            still = None if self._still_since is None else self._now - self._still_since
            if self._now >= self._ends or (still is not None and still >= STILL_SECONDS):
                yield from self._give_up(standing=still is not None)
            signed = yield from self._rest()

    def _query(
        self, request: Request[Any], *, optional: bool = True
    ) -> Generator[Step, Outcome, Any]:
        """Yield a query as soon as it may be sent; return its result."""
        while len(self._sent) >= MOST_QUERIES and self._now < self._sent[-MOST_QUERIES] + 1.0:
            yield from self._listen(self._sent[-MOST_QUERIES] + 1.0)
        sent = self._now
        self._now, result = yield Query(request, max(0.1, self._ends - sent), optional)
        # If no reply came, the client may have sent the query again.
        repeats = min(int((self._now - sent) / REPEAT_SECONDS), MOST_QUERIES)
        again = (self._now - n * REPEAT_SECONDS for n in reversed(range(repeats)))
        self._sent.extend([sent, *again])
        return result

    def _predict(self, position: Any, near: bool) -> Generator[Step, Outcome, None]:
        """Find out when the arm may be there, or else whether it stands still.

        ``position`` is None if the arm did not reply. If the goal's query does not report the
        position, another query is sent. ``near`` says whether the arm could be at the target.
        """
        if self._where is not None and self._goal.decides:
            position = yield from self._query(self._where.request_type())
            if position is None and self._moving is not None:
                # Perhaps this arm cannot report where it is.
                self._where = None
        before, self._before = self._before, None if position is None else (self._now, position)
        self._read_at = self._now + AGAIN_SECONDS
        if position is not None and before is None:
            self._due = inf
            return
        self._due = self._now
        if before is not None and position is not None:
            left = self._goal.distance(position)
            speed = (self._goal.distance(before[1]) - left) / max(self._now - before[0], 1e-6)
            if speed >= SLOWEST:
                self._still_since = None
                # The earliest time: the arm is at full speed, but may have to brake.
                self._due += left / speed + (0.0 if self._ended is None else EVENT_SECONDS)
                self._read_at = max(self._due, self._read_at)
                return
        if not near:
            # The arm may be at the target.
            self._read_at = self._now
            return
        is_moving = None if before is None or position is None else position != before[1]
        if self._moving is not None:
            is_moving = yield from self._query(self._moving.request_type())
        if is_moving is None or is_moving:
            self._still_since = None
        elif self._still_since is None:
            self._still_since = self._now

    def _rest(self) -> Generator[Step, Outcome, bool]:
        """Wait until the next query; return whether the device sent a sign of the end meanwhile."""
        now = self._now
        while self._sent[0] <= now - 1.0 and len(self._sent) > 1:
            self._sent.popleft()
        until = self._sent[-1] + SPACING_SECONDS / max(1, MOST_QUERIES - len(self._sent))
        if self._due > now:
            longest = CONFIRM_SECONDS
            if self._ended is None:
                longest = min(READING_SECONDS, max(FIRST_SECONDS, now - self._started))
            until = max(until, min(self._due, now + longest))
        return (yield from self._listen(min(until, max(now, self._ends))))

    def _listen(self, until: float) -> Generator[Step, Outcome, bool]:
        """Listen until a time; return whether the device sent a sign of the end of a motion.

        Raises:
            RequestRefused: the device reports that the motion has failed.
        """
        self._now, event = yield Listen(until)
        refusal = None
        if self._ended is not None and isinstance(event, Event):
            refusal = self._ended.refusal(event.fields)
        if refusal is not None:
            yield Stop()
            raise RequestRefused(f"the motion to {list(self._goal.target)}", *refusal, b"")
        return event is not None

    def _give_up(self, *, standing: bool) -> Generator[Step, Outcome, NoReturn]:
        """Stop the arm, and raise a MotionTimeout with its state."""
        waited = self._now - self._started
        if standing:
            # A stop ends a pause, which would explain why the arm stands still.
            state = yield from _state(self._table, self._goal)
            stopped = yield Stop()
        else:
            stopped = yield Stop()
            state = yield from _state(self._table, self._goal)
        raise MotionTimeout(self._goal.target, waited, standing, bool(stopped.result), state)


def _state(table: Table, goal: Goal) -> Generator[Step, Outcome, ArmState]:
    """Yield queries for the reasons why the arm is not there; return the replies."""
    roles: tuple[Role, ...] = (goal.position, "powered", "paused", "error")
    found: list[Any] = []
    for role in roles:
        command = table.find_role(role)
        if command is None:
            found.append(None)
        else:
            outcome = yield Query(command.request_type(), STATE_SECONDS, optional=True)
            found.append(outcome.result)
    position, powered, paused, error = found
    position = None if position is None else tuple(position)
    return ArmState(position, powered, paused, error, error_meaning(table, error or 0))


def error_meaning(table: Table, error: int) -> str:
    """Return the meaning of a number of the error register; empty if the edition states none."""
    command = table.find_role("error")
    return "" if command is None else command.reply[0].fields[-1].meaning(error)
