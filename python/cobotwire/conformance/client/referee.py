"""An arm that judges who drives it: a peer to serve, and a report of all that it heard."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from cobotwire import codec as codecs
from cobotwire.conformance.client import script as scripts
from cobotwire.conformance.client.manners import Manners
from cobotwire.conformance.client.past import Heard, Past
from cobotwire.conformance.client.rules import RULES
from cobotwire.conformance.client.script import Script, Told
from cobotwire.conformance.report import Exchange, Report, Result, Verdict
from cobotwire.session.device import DeviceEvent
from cobotwire.sim.arm import SimulatedArm
from cobotwire.table import Table

# As an arm on a USB line: 8.3 to 9 ms a round trip.
DELAY_SECONDS = 0.008


@dataclass(slots=True)
class _Tally:
    kept: int = 0
    broken: int = 0
    reason: str = ""
    evidence: tuple[Exchange, ...] = ()


class Referee:
    """A peer (:mod:`cobotwire.sim.peer`) that answers as an arm and holds requests to the rules."""

    def __init__(
        self,
        table: Table,
        *,
        subject: str = "client",
        manners: Manners | None = None,
        script: Sequence[Told] | None = None,
        acks: bool = True,
        patience: float = 0.03,
        places: Mapping[str, str] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Switch the arm on and wait for requests.

        Args:
            table: the edition that the client must keep to.
            subject: what the report calls the client.
            manners: how answers are delivered; left out: all of them after 8 ms.
            script: what the client was told to send, if that is known.
            acks: whether orders are acknowledged, where the edition says that they may be.
            patience: seconds within which a reply comes or never.
            places: where the spec says each command, for the report.
            clock: gives the time in seconds.

        Raises:
            UsageError: the script cannot be said in this edition.
        """
        self._clock = clock
        self._began = clock()
        self._arm = SimulatedArm(table, clock=clock, watch=self._hear, acks=acks)
        self._arm.state.powered = True
        codec = codecs.load(table)
        self._past = Past(codec, patience)
        self._manners = manners or Manners(DELAY_SECONDS)
        self._script = None if script is None else Script(codec, script)
        self._places = places or {}
        self._last_byte: float | None = None
        self._tallies: dict[tuple[str, str], _Tally] = {}
        self.requests = 0
        began = datetime.now(UTC).isoformat(timespec="seconds")
        self.report = Report("client", table.edition, subject, began)

    @property
    def silence(self) -> float | None:
        """Seconds since the client's last byte; None: it has sent none."""
        return None if self._last_byte is None else self._now() - self._last_byte

    @property
    def wait(self) -> float | None:
        """In how many seconds :meth:`flush` must be called if nothing is heard; None: never."""
        now = self._now()
        waits = [] if self._arm.wait is None else [self._arm.wait]
        if self._manners.due is not None:
            waits.append(max(0.0, self._manners.due - now))
        return min(waits) if waits else None

    def receive(self, data: bytes) -> bytes:
        """Hear ``data``; gives what is due by now."""
        self._last_byte = self._now()
        self._arm.receive(data)
        return self._manners.give(self._now())

    def flush(self) -> bytes:
        """Time has passed; gives what is due by now."""
        now = self._now()
        last = self._last_byte
        if self._arm.wait is not None and last is not None and now >= last + self._arm.wait:
            self._arm.flush()
        return self._manners.give(now)

    def finish(self) -> Report:
        """The client has gone: judge what is left, and close the report."""
        self._arm.flush()
        if self._script is not None:
            for finding in self._script.end():
                self._broken(finding.rule, finding.command, finding.reason, ())
        self._end_text()
        self.report.finished = self.requests > 0
        self.report.results = self._results()
        return self.report

    def _now(self) -> float:
        return self._clock() - self._began

    def _hear(self, event: DeviceEvent, answer: bytes) -> None:
        heard = Heard(self._now(), event, answer)
        for rule in RULES:
            judgement = rule.judge(self._past, heard)
            name = heard.command.name if heard.command is not None else ""
            if judgement:
                self._broken(rule.id, name, judgement, self._past.evidence(heard))
            elif judgement is not None and name:
                self._tally(rule.id, name).kept += 1
        if self._script is not None:
            for finding in self._script.hear(heard):
                evidence = self._past.evidence(heard)
                self._broken(finding.rule, finding.command, finding.reason, evidence)
        self._remember(heard)

    def _remember(self, heard: Heard) -> None:
        self._past.heard.append(heard)
        self._past.powered = self._arm.state.powered
        if heard.command is not None:
            self.requests += 1
        self._manners.take(heard)

    def _end_text(self) -> None:
        due = self._past.text_due()
        if due is not None and due.command is not None:
            reason = f"{due.command.name} lacks the text behind it, or it cannot be read"
            self._broken("text-follows", due.command.name, reason, self._past.evidence(due))

    def _broken(self, rule: str, command: str, reason: str, evidence: tuple[Exchange, ...]) -> None:
        tally = self._tally(rule, command)
        tally.broken += 1
        if tally.broken == 1:
            tally.reason, tally.evidence = reason, evidence

    def _tally(self, rule: str, command: str) -> _Tally:
        return self._tallies.setdefault((rule, command), _Tally())

    def _results(self) -> list[Result]:
        known = {rule.id: (rule.what, rule.source) for rule in RULES}
        known |= {rule: (what, "the script") for rule, what in scripts.RULES.items()}
        results = []
        for (rule, command), tally in self._tallies.items():
            what, source = known[rule]
            place = self._places.get(command, "")
            results.append(_result(rule, command, tally, what, place or source))
        told = self._script is not None
        for rule, what in scripts.RULES.items():
            if not any(broken == rule for broken, _ in self._tallies):
                verdict = Verdict.PASS if told else Verdict.NOT_SUPPORTED
                why = what if told else f"{what}: needs a script (--expect)"
                results.append(Result(rule, "", verdict, why))
        return results


def _result(rule: str, command: str, tally: _Tally, what: str, source: str) -> Result:
    if not tally.broken:
        return Result(rule, command, Verdict.PASS, f"{tally.kept} times: {what}", (), source)
    often = f"{tally.broken} times, first: " if tally.broken > 1 else ""
    return Result(rule, command, Verdict.FAIL, f"{often}{tally.reason}", tally.evidence, source)
