"""Deliver an arm's replies to the client: after a delay and, on request, with faults."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from cobotwire.codec.interface import Codec
from cobotwire.conformance.client.history import REMEMBERED, Received
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator.faults import (
    CommandError,
    Duplicated,
    Fault,
    Late,
    Lost,
    Merged,
    OtherAddress,
    Scenario,
    ServoLeak,
    Split,
    UnrequestedEvent,
)
from cobotwire.simulator.faults.kinds.messages import events_of

# Longer than most clients wait, but shorter than the longest delay in the field notes.
LATE_SECONDS = 0.6
PAUSE_SECONDS = 0.05
# A merged reply waits for the next one, however long that takes.
A_DAY = 86400.0

# A reply comes this long after a message that is not the reply: late enough to reveal a client that
# accepts the message and sends its next request, and still in time for any other client.
SOON_SECONDS = 0.02


def _late(every: int, first: int) -> tuple[Fault, ...]:
    """Return faults that delay a reply after ``every + 1`` and after ``every``, alternately.

    If the distance were fixed, and a client sent its queries in a fixed order, the late replies
    would all be to the same query, and would come when the client waits for that query again.
    """
    if every == 1:
        return (Late(every=1, first=first, seconds=LATE_SECONDS),)
    period = 2 * every + 1
    return tuple(
        Late(every=period, first=at, seconds=LATE_SECONDS) for at in (first, first + every + 1)
    )


# The faults of replies by name. ``every`` and ``first`` select the replies.
FAULTS: Mapping[str, Callable[..., Fault | tuple[Fault, ...]]] = {
    "lost": Lost,
    "late": _late,
    "split": partial(Split, seconds=PAUSE_SECONDS),
    "merged": partial(Merged, at_most_seconds=A_DAY),
    "noise": partial(ServoLeak, packets=("status",)),
    "text": partial(CommandError, only="replies", seconds=SOON_SECONDS),
    "twice": Duplicated,
    "event": partial(UnrequestedEvent, only="replies", seconds=SOON_SECONDS),
    "address": partial(OtherAddress, only="replies", seconds=SOON_SECONDS),
}


def faulty_replies(delay: float, names: Sequence[str] = (), every: int = 3) -> Scenario:
    """Return a scenario that delays each reply by ``delay`` seconds and damages some.

    Every ``every``-th reply has one of the faults ``names``, which take turns.

    Raises:
        UsageError: a name is not a fault's name, or ``every`` is below 1.
    """
    for name in names:
        if name not in FAULTS:
            raise UsageError("misbehave", name, f"some of {', '.join(FAULTS)}")
    if every < 1:
        raise UsageError("every", every, "a whole number from 1")
    period = every * len(names)
    faults = [
        fault for turn, name in enumerate(names, 1) for fault in _made(name, period, every * turn)
    ]
    delays = [Late(seconds=delay)] if delay else []
    return Scenario(name="replies of the referee", faults=(*delays, *faults))


def possible_faults(table: Table) -> list[str]:
    """Return the names of the faults that replies of an edition can have."""
    return [name for name in FAULTS if not _lacks(_made(name, 1, 1)[0], table)]


def _made(name: str, every: int, first: int) -> tuple[Fault, ...]:
    """Return the faults that a name stands for."""
    made = FAULTS[name](every=every, first=first)
    return (made,) if isinstance(made, Fault) else made


def require_possible(scenario: Scenario, table: Table) -> None:
    """Check that the edition has the messages that the faults of a scenario send.

    Raises:
        UsageError: it has no events, or no second address.
    """
    for fault in scenario.faults:
        lacks = _lacks(fault, table)
        if lacks:
            message = f"the edition {table.edition} has no {lacks} for the fault {fault.kind!r}"
            raise UsageError("misbehave", fault.kind, message=message)


def _lacks(fault: Fault, table: Table) -> str:
    """Return what a fault needs and the edition lacks; empty if it lacks nothing."""
    if isinstance(fault, UnrequestedEvent) and not events_of(table):
        return "events"
    if isinstance(fault, OtherAddress) and len(table.frame.addresses) < 2:
        return "second address"
    return ""


class _KnownReply:
    """The peer that the faults wrap: it returns the reply that the arm has computed."""

    wait = None

    def __init__(self) -> None:
        self.reply = b""

    def receive(self, data: bytes) -> bytes:
        """Return the reply to the request."""
        return self.reply

    def flush(self) -> bytes:
        """Return nothing: an arm never sends anything by itself."""
        return b""


class Delivery:
    """Sends the arm's replies to the client, with the faults of a scenario."""

    def __init__(self, scenario: Scenario, codec: Codec, clock: Callable[[], float]) -> None:
        """Start the scenario; ``clock`` gives the time in seconds since the run began."""
        self._clock = clock
        self._arm = _KnownReply()
        self._count = 0
        self._awaiting: dict[int, Received] = {}
        self._faulty = scenario.wrap(self._arm, codec, clock=clock, on_reply=self._replied)

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`due` returns something; None: nothing is planned."""
        return self._faulty.wait

    def plan(self, request: Received) -> bytes:
        """Plan the reply to a request, if there is one; return what is due by now."""
        if not request.reply:
            return b""
        self._arm.reply = request.reply
        self._awaiting[self._count] = request
        # A lost reply is never reported as sent, so its request is dropped here in the end.
        self._awaiting.pop(self._count - REMEMBERED, None)
        self._count += 1
        return self._faulty.receive(request.data)

    def due(self) -> bytes:
        """Return what is due by now."""
        return self._faulty.flush()

    def _replied(self, number: int) -> None:
        request = self._awaiting.pop(number, None)
        if request is not None:
            request.replied_at = self._clock()
