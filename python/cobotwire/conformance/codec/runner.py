"""Asks an implementation every trial and reports which rules it keeps, by command."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime

from cobotwire.conformance.codec.expected import Expectation, expectation_of
from cobotwire.conformance.codec.implementation import Implementation, NoAnswer
from cobotwire.conformance.codec.judge import ABILITIES, RULES, Finding, judge
from cobotwire.conformance.codec.trials import Trial
from cobotwire.conformance.report import Exchange, Report, Result, Verdict
from cobotwire.errors import UsageError
from cobotwire.table import Table

PROTOCOL = 1
# An implementation that ended or hung so often is not asked any more.
MOST_CRASHES = 5
SOURCE = "docs/codec-protocol.md"


@dataclass(slots=True)
class _Tally:
    """What became of the trials of one rule and command."""

    asked: int = 0
    refused: str = ""
    excused: str = ""
    complaints: list[tuple[Trial, str, tuple[Exchange, ...]]] = field(default_factory=list)
    unstable: str = ""


@dataclass(frozen=True, slots=True)
class Greeting:
    """What an implementation says of itself."""

    name: str
    can: frozenset[str]


def greet(implementation: Implementation, table: Table) -> Greeting:
    """Ask who it is.

    Raises:
        UsageError: it speaks another protocol or edition, or its greeting is none.
        NoAnswer: it says nothing.
    """
    hello = implementation.ask({"do": "hello", "protocol": PROTOCOL, "edition": table.edition})
    if "error" in hello:
        raise UsageError("implementation", hello["error"], "one that takes the greeting")
    if hello.get("protocol") != PROTOCOL:
        raise UsageError("implementation: protocol", hello.get("protocol"), str(PROTOCOL))
    if hello.get("edition") != table.edition:
        raise UsageError("implementation: edition", hello.get("edition"), table.edition)
    can = hello.get("can")
    if not isinstance(can, list) or not all(isinstance(word, str) for word in can):
        raise UsageError("implementation: can", can, "a list of words, as docs/codec-protocol.md")
    return Greeting(str(hello.get("name", "unnamed")), frozenset(can))


class Run:
    """One run; ``report`` is readable at any time, and says when it is not finished."""

    def __init__(
        self,
        table: Table,
        implementation: Implementation,
        *,
        expected: Sequence[Expectation] = (),
        repeat: int = 1,
        places: Mapping[str, str] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Greet the implementation.

        Args:
            table: the edition that it must keep to.
            implementation: who is asked.
            expected: failures that are known.
            repeat: how often each trial is asked; answers that differ are unstable.
            places: where the spec says each command, for the report.
            clock: gives the time in seconds, for the evidence.

        Raises:
            UsageError, NoAnswer: as :func:`greet`.
        """
        self._table = table
        self._implementation = implementation
        self._expected = list(expected)
        self._repeat = repeat
        self._places = places or {}
        self._clock = clock
        self._began = clock()
        self._crashes = 0
        self._tallies: dict[tuple[str, str], _Tally] = {}
        self.greeting = greet(implementation, table)
        began = datetime.now(UTC).isoformat(timespec="seconds")
        self.report = Report("codec", table.edition, self.greeting.name, began)

    def ask_all(self, trials: Iterable[Trial], *, until_failure: bool = False) -> Report:
        """Ask every trial; with ``until_failure`` no more once one has failed.

        The report holds what is known so far, whatever ends this.
        """
        try:
            for trial in trials:
                self._try(trial)
                if until_failure and any(t.complaints for t in self._tallies.values()):
                    break
            else:
                self.report.finished = True
        finally:
            self.report.results = self._results()
        return self.report

    def _try(self, trial: Trial) -> None:
        if trial.needs not in self.greeting.can:
            self._tally(trial.rule, trial).refused = f"it does not offer to {trial.needs}"
            return
        if self._crashes >= MOST_CRASHES:
            wrong = f"not asked: it had ended or hung {MOST_CRASHES} times"
            self._note(trial, [Finding("answers", wrong)], ())
            return
        first: list[Finding] | None = None
        for _ in range(self._repeat):
            findings, evidence = self._once(trial)
            if first is None:
                first = findings
                self._note(trial, findings, evidence)
            elif findings != first:
                self._tally(trial.rule, trial).unstable = f"{trial.name}: {first} then {findings}"

    def _once(self, trial: Trial) -> tuple[list[Finding], tuple[Exchange, ...]]:
        asked_at = self._clock() - self._began
        question = Exchange(asked_at, "sent", json.dumps(trial.ask).encode())
        try:
            answer = self._implementation.ask(trial.ask)
        except NoAnswer as error:
            self._crashes += 1
            return [Finding("answers", str(error))], (question,)
        heard_at = self._clock() - self._began
        heard = Exchange(heard_at, "heard", json.dumps(answer).encode()[:2000])
        if "unsupported" in answer:
            self._tally(trial.rule, trial).refused = str(answer["unsupported"])
            return [], (question, heard)
        findings = list(judge(self._table, trial, answer, self.greeting.can))
        return [Finding("answers", ""), *findings], (question, heard)

    def _note(
        self, trial: Trial, findings: Sequence[Finding], evidence: tuple[Exchange, ...]
    ) -> None:
        wrong = [finding for finding in findings if finding.complaint]
        known = expectation_of(self._expected, trial.name) if self._expected else None
        if known is not None and findings:
            if wrong:
                known.met += 1
            else:
                known.passed.append(trial.name)
        for finding in findings:
            tally = self._tally(finding.rule, trial)
            tally.asked += 1
            if finding.complaint and known is not None:
                tally.excused = f"expected to fail ({known.place}): {known.reason}"
            elif finding.complaint:
                tally.complaints.append((trial, finding.complaint, evidence))

    def _tally(self, rule: str, trial: Trial) -> _Tally:
        command = "" if rule == "answers" else trial.command
        return self._tallies.setdefault((rule, command), _Tally())

    def _results(self) -> list[Result]:
        results = [
            _result(rule, command, tally, self._places.get(command, SOURCE))
            for (rule, command), tally in self._tallies.items()
        ]
        for rule, ability in ABILITIES.items():
            if ability not in self.greeting.can:
                why = f"it does not offer to tell {ability}"
                results.append(Result(rule, "", Verdict.NOT_SUPPORTED, why, (), SOURCE))
        return results + [_unexpected(known) for known in self._expected if _wrong(known)]


def _result(rule: str, command: str, tally: _Tally, source: str) -> Result:
    if tally.complaints:
        trial, complaint, evidence = tally.complaints[0]
        failed = f"{len(tally.complaints)} of {tally.asked} failed; {trial.name}: {complaint}"
        return Result(rule, command, Verdict.FAIL, failed, evidence, source)
    if tally.unstable:
        return Result(rule, command, Verdict.UNSTABLE, tally.unstable, (), source)
    if tally.excused or (tally.refused and not tally.asked):
        why = tally.excused or tally.refused
        return Result(rule, command, Verdict.NOT_SUPPORTED, why, (), source)
    kept = f"{tally.asked} trials: {RULES[rule]}"
    return Result(rule, command, Verdict.PASS, kept, (), source)


def _wrong(known: Expectation) -> bool:
    return bool(known.passed) or not known.met


def _unexpected(known: Expectation) -> Result:
    """A line that says more than is true would hide the next failure."""
    if known.passed:
        why = f"{known.place}: {len(known.passed)} passed, among them {known.passed[0]}"
    else:
        why = f"{known.place}: no trial is called {known.pattern}, or none was asked"
    return Result("expected-failure", "", Verdict.FAIL, why, (), known.place)
