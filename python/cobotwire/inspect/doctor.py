"""Examine an arm and its port: harmless queries, their times, and all other traffic."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from shlex import quote
from statistics import median
from typing import Any, NamedTuple

from cobotwire.client import Client
from cobotwire.codec.interface import Codec
from cobotwire.inspect import advice, readiness
from cobotwire.inspect.advice import Problem
from cobotwire.inspect.cross_checks import doubts
from cobotwire.inspect.identification import other_edition
from cobotwire.inspect.latency_timer import latency_timer
from cobotwire.inspect.traffic_listener import DiagnosingListener
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.transport import OpenedTransport

# The time to listen before the first request: what is received then was not requested.
QUIET_SECONDS = 0.3
# After this many requests in a row without a reply, no more are sent.
SILENT = 3
# An adapter that holds replies back takes 16 ms or more; otherwise a round trip is below 13 ms.
SLOW_SECONDS = 0.0155
# Within how many seconds an arm replies to a query that shows its edition.
EDITION_SECONDS = 0.5
ROLES: tuple[Role, ...] = (*readiness.ROLES, "moving", "joints", "coordinates")


class RoundTrip(NamedTuple):
    """Times of round trips, in seconds."""

    shortest: float
    median: float
    longest: float


@dataclass
class Report:
    """The results of an examination so far.

    Attributes:
        url: the port.
        edition: the edition that the client uses.
        kind: the kind of transport; empty if the port was never open.
        low_latency: whether the port was set to low latency.
        latency_timer_ms: the adapter's latency timer, if the system has one.
        values: the results of the queries by command name.
        requests: the number of requests that were sent.
        replies: the number of legal replies.
        late: the number of replies that came after their deadline.
        noise: the bytes of noise.
        diagnosis: what the noise is, in a sentence.
        round_trip: the times of the round trips.
        problems: what is wrong, and what to do about it.
    """

    url: str
    edition: str
    kind: str = ""
    low_latency: bool = False
    latency_timer_ms: int | None = None
    values: dict[str, Any] = field(default_factory=dict)
    requests: int = 0
    replies: int = 0
    late: int = 0
    noise: int = 0
    diagnosis: str = ""
    round_trip: RoundTrip | None = None
    problems: list[Problem] = field(default_factory=list)

    @property
    def healthy(self) -> bool:
        """Whether there is no serious problem."""
        return not any(problem.serious for problem in self.problems)

    def add_port_failure(self, error: LinkError) -> None:
        """Insert a first problem: the port could not be opened, or it disappeared."""
        self.problems.insert(0, Problem("link", str(error), advice.PORT if self.kind else ""))


def harmless_queries(table: Table) -> list[Command]:
    """Return the queries that have a role, or else one query without arguments.

    Other queries are not sent, because a query that a firmware did not know froze it until its
    power was cut.
    """
    queries = [c for c in table.commands if c.safety == "query" and not c.event]
    known = [command for command in queries if command.role in ROLES]
    if not known:
        bare = (c for c in queries if c.reply and not any(v.fields for v in c.request))
        known = [command for command, _ in zip(bare, range(1))]
    return sorted(known, key=lambda command: ROLES.index(command.role) if command.role else 0)


class Doctor:
    """Examines an arm and fills a report, which stays valid if the port disappears meanwhile."""

    def __init__(
        self, arm: Client, transport: OpenedTransport, codec: Codec, report: Report
    ) -> None:
        self._arm, self._transport, self._table = arm, transport, codec.table
        self._queries = harmless_queries(codec.table)
        self._listener = DiagnosingListener(codec)
        self._times: list[float] = []
        self._silent = 0
        self._illegal: list[str] = []
        # The names of the queries without a reply, each once.
        self._unanswered: dict[str, None] = {}
        self._report = report
        report.kind, report.low_latency = transport.kind, transport.low_latency

    def examine(self, count: int) -> Report:
        """Listen, send each query once, then send the query for the joints ``count`` times."""
        remove_listener = self._arm.add_traffic_listener(self._listener)
        try:
            self._arm.listen(QUIET_SECONDS)
            timed = [c for c in self._queries if c.role == "joints"] or self._queries[:1]
            for command in [*self._queries, *timed * count]:
                self._send(command)
            self._arm.listen(QUIET_SECONDS)
            if self._report.replies:
                self._check_edition()
        finally:
            remove_listener()
            self._conclude()
        return self._report

    def _send(self, command: Command) -> None:
        if self._silent >= SILENT:
            return
        self._report.requests += 1
        started = time.perf_counter()
        try:
            value = getattr(self._arm, command.name)()
        except ReplyTimeout:
            self._silent += 1
            self._unanswered[command.name] = None
            return
        except ProtocolError as error:
            self._illegal.append(f"{command.name}: {error}")
        else:
            self._times.append(time.perf_counter() - started)
            self._report.replies += 1
            self._report.values[command.name] = value
        self._silent = 0

    def _check_edition(self) -> None:
        """Report an arm that speaks another edition; most of its replies are legal in both."""
        own, other = other_edition(self._arm, self._table, self._transport, timeout=EDITION_SECONDS)
        if other is not None:
            text = (
                f"the arm speaks edition {other.edition}, not {self._table.edition}: it replies to "
                f"{other.query}, but not to {own.query}; values can be wrong by a factor of ten"
            )
            how = advice.OTHER_EDITION.format(edition=other.edition)
            self._report.problems.append(Problem("other-edition", text, how))

    def _conclude(self) -> None:
        report, listener = self._report, self._listener
        listener.flush()
        report.late, report.noise = listener.late, listener.noise
        report.diagnosis = str(listener.findings)
        if self._times:
            report.round_trip = RoundTrip(min(self._times), median(self._times), max(self._times))
        report.problems += self._reply_problems()
        report.problems += advice.problems_in(listener.findings)
        report.problems += self._latency_problems()

    def _reply_problems(self) -> list[Problem]:
        report, found = self._report, []
        if self._illegal:
            text = f"illegal replies: {len(self._illegal)}, the first to {self._illegal[0]}"
            found.append(
                Problem("illegal-reply", text, advice.ILLEGAL.format(url=quote(report.url)))
            )
        lost = report.requests - report.replies - len(self._illegal)
        if lost and lost == report.requests:
            text = f"no reply to any of {lost} requests"
            found.append(Problem("silence", text, advice.NO_REPLIES))
        elif lost:
            found += self._lost_replies(lost)
        if report.late:
            text = f"replies after their deadline: {report.late}"
            found.append(Problem("late-replies", text, advice.LATE))
        for text in doubts(self._table, report.values):
            found.append(Problem("values", text, advice.VALUES.format(url=quote(report.url))))
        states = {command.role: report.values.get(command.name) for command in self._queries}
        return found + readiness.problems(self._table, states, report.url)

    def _lost_replies(self, lost: int) -> list[Problem]:
        """Report unanswered requests; a simulated arm of unknown geometry has no coordinates."""
        found = []
        coordinates = self._table.find_role("coordinates")
        known = self._table.robot.geometry is not None
        if not known and coordinates and coordinates.name in self._unanswered:
            text = f"no reply to {coordinates.name}; the edition has no geometry of this robot"
            found.append(Problem("no-coordinates", text, advice.NO_COORDS, serious=False))
            del self._unanswered[coordinates.name]
            lost -= 1
        if lost:
            names = ", ".join(self._unanswered)
            text = f"no reply in time to {lost} of {self._report.requests} requests ({names})"
            found.append(Problem("lost-replies", text, advice.LOST))
        return found

    def _latency_problems(self) -> list[Problem]:
        report = self._report
        timer = latency_timer(report.url)
        if timer is not None:
            report.latency_timer_ms, path = timer
            if report.latency_timer_ms <= 1:
                return []
            text = f"the port holds short replies back for {report.latency_timer_ms} ms"
            return [Problem("latency-timer", text, advice.LATENCY_TIMER.format(path=path))]
        times = report.round_trip
        if times is not None and times.median > SLOW_SECONDS and report.kind == "serial":
            text = f"a round trip takes {times.median * 1e3:.1f} ms"
            return [Problem("slow", text, advice.SLOW, serious=False)]
        return []
