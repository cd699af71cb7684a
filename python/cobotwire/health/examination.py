"""An examination: harmless questions, their times, and what is heard besides."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from statistics import median
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.driver import Driver
from cobotwire.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.health import advice
from cobotwire.health.advice import Complaint
from cobotwire.health.ear import Ear
from cobotwire.health.latency import latency_timer
from cobotwire.table import Command, Role, Safety, Table
from cobotwire.transport import Link

# Before the first question: what comes then, comes unasked.
QUIET_SECONDS = 0.3
# After so many questions in a row without an answer no more are asked.
SILENT = 3
# A bridge that holds replies back takes 16 ms or more; without that a round trip is below 13 ms.
SLOW_SECONDS = 0.0155
ROLES: tuple[Role, ...] = ("powered", "moving", "joints", "coordinates")
HARMLESS: Safety = "query"


class Times(NamedTuple):
    """Round trips in seconds."""

    shortest: float
    median: float
    longest: float


@dataclass
class Report:
    """What an examination found; it grows while that goes on."""

    url: str
    edition: str
    kind: str
    low_latency: bool
    latency_timer_ms: int | None = None
    answers: dict[str, Any] = field(default_factory=dict)
    asked: int = 0
    answered: int = 0
    late: int = 0
    noise: int = 0
    diagnosis: str = ""
    round_trip: Times | None = None
    complaints: list[Complaint] = field(default_factory=list)

    @property
    def healthy(self) -> bool:
        """Whether nothing grave was found."""
        return not any(complaint.grave for complaint in self.complaints)

    def lost(self, error: LinkError) -> None:
        """The link could not be opened, or went away: that comes before all else."""
        self.complaints.insert(0, Complaint("link", str(error), advice.LINK))


def questions(table: Table) -> list[Command]:
    """What is asked: the queries whose roles say that they are harmless, as far as there are any.

    Not all queries: one that a firmware does not know froze it until its power was cut.
    """
    queries = [command for command in table.commands if command.safety == HARMLESS]
    known = [command for command in queries if command.role in ROLES]
    if not known:
        known = [c for c in queries if c.reply and not any(form.fields for form in c.request)][:1]
    return sorted(known, key=lambda command: ROLES.index(command.role) if command.role else 0)


class Examination:
    """Examines an arm; ``report`` has what was found so far, also when the link went away."""

    def __init__(self, arm: Driver, link: Link, codec: Codec) -> None:
        self._arm, self._table = arm, codec.table
        self._ear = Ear(codec)
        self._times: list[float] = []
        self._silent = 0
        self._illegal: list[str] = []
        self.report = Report(link.url, codec.table.edition, link.kind, link.low_latency)

    def run(self, count: int) -> Report:
        """Listen, ask each question once, and then ``count`` times for the joints."""
        end = self._arm.watch(self._ear)
        try:
            self._arm.listen(QUIET_SECONDS)
            asked = questions(self._table)
            for command in asked:
                self._ask(command)
            timed = [c for c in asked if c.role == "joints"] or asked[:1]
            for command in timed * count:
                self._ask(command)
            self._arm.listen(QUIET_SECONDS)
        finally:
            end()
            self._conclude()
        return self.report

    def _ask(self, command: Command) -> None:
        if self._silent >= SILENT:
            return
        self.report.asked += 1
        started = time.perf_counter()
        try:
            answer = getattr(self._arm, command.name)()
        except ReplyTimeout:
            self._silent += 1
        except ProtocolError as error:
            self._illegal.append(f"{command.name}: {error}")
            self._silent = 0
        else:
            self._times.append(time.perf_counter() - started)
            self._silent = 0
            self.report.answered += 1
            self.report.answers[command.name] = answer

    def _conclude(self) -> None:
        report, ear = self.report, self._ear
        ear.pause()
        report.late, report.noise, report.diagnosis = ear.late, ear.noise, str(ear.findings)
        if self._times:
            report.round_trip = Times(min(self._times), median(self._times), max(self._times))
        report.complaints += [
            *self._of_answers(),
            *advice.complaints_of(ear.findings),
            *self._of_latency(),
        ]

    def _of_answers(self) -> list[Complaint]:
        report, found = self.report, []
        if self._illegal:
            says = f"{len(self._illegal)} x an illegal reply, first to {self._illegal[0]}"
            found.append(Complaint("illegal-reply", says, advice.ILLEGAL))
        lost = report.asked - report.answered - len(self._illegal)
        if report.asked and not report.answered and not self._illegal:
            says = f"none of {report.asked} questions was answered"
            found.append(Complaint("silence", says, advice.SILENT))
        elif lost > 0:
            says = f"{lost} of {report.asked} questions were not answered in time"
            found.append(Complaint("lost-replies", says, advice.LOST))
        if report.late:
            found.append(Complaint("late-replies", f"{report.late} came too late", advice.LATE))
        for command in questions(self._table):
            if command.role == "powered" and report.answers.get(command.name) is False:
                found.append(Complaint("no-power", "the arm has no power", advice.NO_POWER, False))
        return found

    def _of_latency(self) -> list[Complaint]:
        report = self.report
        timer = latency_timer(report.url)
        report.latency_timer_ms = None if timer is None else timer[0]
        if timer is not None and timer[0] > 1:
            says = f"the port's latency timer is at {timer[0]} ms: short replies are held back"
            return [Complaint("latency-timer", says, advice.BUSY_TIMER.format(path=timer[1]))]
        slow = report.round_trip is not None and report.round_trip.median > SLOW_SECONDS
        if slow and report.kind == "serial" and timer is None:
            assert report.round_trip is not None, "or it is not slow"
            says = f"a round trip takes {report.round_trip.median * 1e3:.1f} ms"
            return [Complaint("slow", says, advice.SLOW, grave=False)]
        return []


def unopened(url: str, edition: str) -> Report:
    """The report on a link before it is open."""
    return Report(url, edition, "", low_latency=False)
