"""Sample joints and coordinates of an arm, together with the state of its port."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterator
from typing import Any, NamedTuple

from cobotwire.client import Client
from cobotwire.codec.interface import Codec
from cobotwire.inspect.traffic_listener import DiagnosingListener
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout, UsageError
from cobotwire.protocol.table import Command, Role, Table

# The rate is computed over this many samples, the most recent ones.
WINDOW = 10
FASTEST = 1000.0
ROLES: tuple[Role, ...] = ("joints", "coordinates")


class Observation(NamedTuple):
    """The state of the arm and its port at one time.

    Attributes:
        time: seconds since the first sample.
        values: the results by command name; None if there was no legal reply.
        rate: samples a second over the last few; 0 for the first.
        sent: requests that were sent, repeats included, so far.
        unanswered: those of them without a legal reply in time.
        late: replies that came after their deadline, or after the reply to a repeat, so far.
        noise: bytes of noise, so far.
        diagnosis: what that noise is, in a sentence.
        error: the last error of this sample; empty if there was none.
    """

    time: float
    values: dict[str, Any]
    rate: float
    sent: int
    unanswered: int
    late: int
    noise: int
    diagnosis: str
    error: str


def monitored(table: Table) -> list[Command]:
    """Return the queries of joints and coordinates that an edition has.

    Raises:
        UsageError: it has none.
    """
    if found := [each for role in ROLES for each in table.commands if each.role == role]:
        return found
    message = f"nothing to monitor: {table.edition} has no query of joints or coordinates"
    raise UsageError("edition", table.edition, message=message)


class Monitor:
    """Samples the joints and coordinates of an arm, and listens to the port in between.

    A sample with a missing reply is part of the result, so that the user sees that the arm is
    silent. A client's ``stream()`` skips this sample.
    """

    def __init__(self, arm: Client, codec: Codec, rate: float) -> None:
        """Take at most ``rate`` samples a second.

        Raises:
            UsageError: the rate is not allowed, or the edition has no query to monitor.
        """
        if not 0 < rate <= FASTEST:
            raise UsageError("rate", rate, f"above 0, up to {FASTEST:g}")
        self._arm, self._rate = arm, rate
        self._commands = monitored(codec.table)
        self._listener = DiagnosingListener(codec)
        self._answered = 0
        self._error = ""
        # Why a simulated arm cannot reply, by command: it is not asked again.
        self._refused: dict[str, str] = {}

    def samples(self, count: int | None = None) -> Iterator[Observation]:
        """Yield ``count`` samples, or samples without end.

        Raises:
            LinkError: the port disappeared.
        """
        remove_listener = self._arm.add_traffic_listener(self._listener)
        times: deque[float] = deque(maxlen=WINDOW)
        started = due = time.monotonic()
        taken = 0
        try:
            while count is None or taken < count:
                times.append(time.monotonic())
                yield self._sample(started, times)
                taken += 1
                # Missed samples are not taken later, because the arm is busy enough.
                due = max(due + 1 / self._rate, time.monotonic())
                if taken != count:
                    self._arm.listen(max(0.0, due - time.monotonic()))
        finally:
            remove_listener()

    def _sample(self, started: float, times: deque[float]) -> Observation:
        self._error = ""
        values = {command.name: self._query(command) for command in self._commands}
        span = times[-1] - times[0]
        listener = self._listener
        listener.flush()
        return Observation(
            time=times[-1] - started,
            values=values,
            rate=(len(times) - 1) / span if span else 0.0,
            sent=listener.sent,
            unanswered=listener.sent - self._answered,
            late=listener.late,
            noise=listener.noise,
            diagnosis=str(listener.findings),
            error=self._error,
        )

    def _query(self, command: Command) -> Any:
        if command.name in self._refused:
            self._error = self._refused[command.name]
            return None
        try:
            value = getattr(self._arm, command.name)()
        except (ReplyTimeout, ProtocolError) as error:
            self._error = str(error)
            if isinstance(error, ReplyTimeout) and error.refusal:
                self._refused[command.name] = self._error
            return None
        self._answered += 1
        return value
