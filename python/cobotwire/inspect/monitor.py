"""Sample joints and coordinates of an arm, together with the state of its port."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterator
from itertools import repeat
from math import inf
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.client import Client
from cobotwire.codec.interface import Codec, Frame
from cobotwire.inspect.following import FollowedRecording
from cobotwire.inspect.traffic_listener import DiagnosingListener
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout, UsageError
from cobotwire.protocol.messages import Reply
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.session import Traffic, UnexpectedFrame

# The rate is computed over this many samples, the most recent ones.
WINDOW = 10
FASTEST = 1000.0
# Older values are not shown.
FRESH_SECONDS = 2.0
ROLES: tuple[Role, ...] = ("joints", "coordinates")


class Observation(NamedTuple):
    """The state of the arm and its port at one time.

    Attributes:
        time: seconds since the first sample.
        values: the results by command name; None if there was no legal reply.
        rate: samples a second over the last few; 0 for the first.
        sent: requests that were sent, repeats included, so far.
        unanswered: how many of these requests had no legal reply in time.
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


def check_rate(rate: float) -> float:
    """Check a number of samples a second, and return it.

    Raises:
        UsageError: it is not allowed.
    """
    if not 0 < rate <= FASTEST:
        raise UsageError("rate", rate, f"above 0, up to {FASTEST:g}")
    return rate


class Monitor:
    """Samples the joints and coordinates of an arm, and listens to the port in between.

    A sample with a missing reply is part of the result, so that the user sees that the arm is
    silent. A client's ``stream()`` skips such a sample.
    """

    def __init__(self, arm: Client, codec: Codec, rate: float) -> None:
        """Take at most ``rate`` samples a second.

        Raises:
            UsageError: the rate is not allowed, or the edition has no query to monitor.
        """
        self._arm, self._rate = arm, check_rate(rate)
        self._commands = monitored(codec.table)
        self._listener = DiagnosingListener(codec)
        self._answered = 0
        self._error = ""
        # Why a simulated arm cannot reply, by command: such a query is not sent again.
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
                # Missed samples are skipped: catching up would load an arm that is already too
                # slow.
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


class FollowingMonitor:
    """Shows the joints and coordinates that another program queries, and sends nothing.

    A value is from the newest reply; None if none came for ``FRESH_SECONDS``. The rate counts
    replies with joints. A reply belongs to the newest request of its id, so none is late.
    """

    def __init__(self, followed: FollowedRecording, rate: float) -> None:
        """Take ``rate`` samples a second; raise as :class:`Monitor`."""
        self._interval = 1 / check_rate(rate)
        self._followed = followed
        self._listener = DiagnosingListener(codecs.load(followed.table))
        self._values = {command: (-inf, None) for command in monitored(followed.table)}
        self._times: deque[float] = deque(maxlen=WINDOW)
        self._replied = {each.id for each in followed.table.commands if each.requires_reply}
        # The ids of requests that have no reply yet; how many requests were followed by the next
        # one of their id before a reply came.
        self._open: set[int] = set()
        self._unanswered = 0
        self._error = ""

    def samples(self, count: int | None = None) -> Iterator[Observation]:
        """Yield ``count`` samples, or samples until the recording ends.

        Raises:
            LinkError: the recording has ended.
        """
        started = due = time.monotonic()
        for _ in repeat(None) if count is None else repeat(None, count):
            due = max(due + self._interval, time.monotonic())
            time.sleep(max(0.0, due - time.monotonic()))
            # Read the problem before the traffic: what came before the problem is still shown.
            problem, self._error = self._followed.problem, ""
            for traffic in self._followed.take():
                self._take(traffic)
            yield self._sample(started)
            if problem:
                raise LinkError(self._followed.source, problem)

    def _take(self, traffic: Traffic) -> None:
        self._listener(traffic)
        if isinstance(traffic.event, UnexpectedFrame):
            frame = traffic.event.frame
            self._open.discard(frame.command)
            for command in self._values:
                if command.id == frame.command:
                    self._read(command, frame, traffic.time)
        elif traffic.event is None and (id := self._id_of(traffic.data)) in self._replied:
            self._unanswered += id in self._open
            self._open.add(id)

    def _id_of(self, request: bytes) -> int:
        frame = self._followed.table.frame
        return frame.read_id(request) if len(request) >= frame.head_size else -1

    def _read(self, command: Command, frame: Frame, at: float) -> None:
        try:
            reply = frame.decode("reply", of=command.name).typed
        except ProtocolError as error:
            self._error = str(error)
            return
        assert isinstance(reply, Reply), "decoded as a reply"
        self._values[command] = at, reply.result
        if command is next(iter(self._values)):
            self._times.append(at)

    def _sample(self, started: float) -> Observation:
        now, listener = time.monotonic(), self._listener
        listener.flush()
        fresh = now - FRESH_SECONDS
        span = self._times[-1] - self._times[0] if self._times else 0.0
        return Observation(
            time=now - started,
            values={each.name: v if at > fresh else None for each, (at, v) in self._values.items()},
            rate=(len(self._times) - 1) / span if span and self._times[-1] > fresh else 0.0,
            sent=listener.sent,
            unanswered=self._unanswered + len(self._open),
            late=0,
            noise=listener.noise,
            diagnosis=str(listener.findings),
            error=self._error,
        )
