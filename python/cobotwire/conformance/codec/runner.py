"""Ask an implementation every question, and report a verdict on each test case by command."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from cobotwire.conformance.codec.check import ABILITIES, check
from cobotwire.conformance.codec.implementation import Implementation, NoAnswer
from cobotwire.conformance.codec.questions.question import Question
from cobotwire.conformance.codec.suite import ANSWERS
from cobotwire.conformance.expected import Expectation, excuse, outdated
from cobotwire.conformance.report import Cause, Exchange, Report, Result
from cobotwire.conformance.suite import TestCase
from cobotwire.conformance.tally import Evidence, Observation, Tally
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table

PROTOCOL = 1
# After this many crashes or hangs, no more questions are asked.
MOST_CRASHES = 5


@dataclass(frozen=True, slots=True)
class Greeting:
    """The name and the abilities that an implementation reports."""

    name: str
    can: frozenset[str]


def greet(implementation: Implementation, table: Table) -> Greeting:
    """Ask an implementation for its name and abilities.

    Raises:
        UsageError: it has another protocol or edition, or its greeting is malformed.
        NoAnswer: it does not answer.
    """
    hello = implementation.ask({"do": "hello", "protocol": PROTOCOL, "edition": table.edition})
    if "error" in hello:
        message = f"the implementation rejected the greeting: {hello['error']}"
        raise UsageError("implementation", message=message)
    for key, words, right in (
        ("protocol", "speaks protocol", PROTOCOL),
        ("edition", "has edition", table.edition),
    ):
        if hello.get(key) != right:
            message = f"the implementation {words} {hello.get(key)!r}, not {right}"
            raise UsageError("implementation", message=message)
    can = hello.get("can")
    if not isinstance(can, list) or not all(isinstance(word, str) for word in can):
        message = f"the implementation lists {can!r} under can, not words: docs/codec-protocol.md"
        raise UsageError("implementation", can, message=message)
    return Greeting(str(hello.get("name", "unnamed")), frozenset(can))


class Run:
    """One run; ``report`` is readable at any time; it is marked as unfinished until the end."""

    def __init__(
        self,
        table: Table,
        implementation: Implementation,
        *,
        expected: Sequence[Expectation] = (),
        repeat: int = 1,
        sources: Mapping[str, str] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Greet the implementation.

        Args:
            table: the edition that it must conform to.
            implementation: the codec under test.
            expected: the known failures.
            repeat: how often each question is asked; answers that differ are unstable.
            sources: where the spec defines each command, for the report.
            clock: gives the time in seconds, for the evidence.

        Raises:
            UsageError, NoAnswer: as :func:`greet`.
        """
        self._table = table
        self._implementation = implementation
        self._expected = list(expected)
        self._repeat = repeat
        self._clock = clock
        self._started = clock()
        self._crashes = 0
        self._tally = Tally(sources)
        self.greeting = greet(implementation, table)
        self.report = Report("codec", table.edition, self.greeting.name)

    def ask_all(self, questions: Iterable[Question], *, until_failure: bool = False) -> Report:
        """Ask every question; with ``until_failure`` stop after the first failure.

        The report holds the results so far, even if an exception ends the run.
        """
        left = iter(questions)
        try:
            for question in left:
                self._ask(question)
                if until_failure and self._tally.failed:
                    break
                if self._crashes >= MOST_CRASHES:
                    self.report.stopped = f"the codec had ended or hung {MOST_CRASHES} times"
                    break
            else:
                self.report.finished = True
        except KeyboardInterrupt:
            self.report.stopped = "the run was interrupted"
            raise
        finally:
            if self.report.stopped:
                self._leave_out(left)
            self.report.results = self._results()
            self.report.seconds = self._clock() - self._started
        return self.report

    def _leave_out(self, questions: Iterable[Question]) -> None:
        """Report as not run the test cases of the questions that are left."""
        for case, command in {(each.case, each.command) for each in questions}:
            reason = f"{self.report.stopped}."
            self._tally.excuse(case, command, Cause.RUN_ENDED, reason)

    def _ask(self, question: Question) -> None:
        if question.needs not in self.greeting.can:
            self._unsupported(question, f"it does not list the ability {question.needs!r}")
            return
        first: list[Observation] | None = None
        for _ in range(self._repeat):
            found, evidence = self._ask_once(question)
            if first is None:
                first = found
                self._observe(question, found, evidence)
            elif found != first:
                reason = f"{question.name}: {_in_words(first)}; then {_in_words(found)}"
                self._tally.excuse(question.case, question.command, Cause.UNSTABLE, reason)

    def _ask_once(self, question: Question) -> tuple[list[Observation], Evidence]:
        at = self._clock() - self._started
        sent = Exchange(at, "sent", json.dumps(question.ask).encode())
        try:
            answer = self._implementation.ask(question.ask)
        except NoAnswer as error:
            self._crashes += 1
            return [Observation(ANSWERS, str(error))], (sent,)
        at = self._clock() - self._started
        evidence = (sent, Exchange(at, "received", json.dumps(answer).encode()[:2000]))
        if "unsupported" in answer:
            self._unsupported(question, str(answer["unsupported"]))
            return [], evidence
        found = check(self._table, question, answer, self.greeting.can)
        return [Observation(ANSWERS), *found], evidence

    def _unsupported(self, question: Question, reason: str) -> None:
        self._tally.expect(question.case, question.command, reason)

    def _observe(
        self, question: Question, found: Sequence[Observation], evidence: Evidence
    ) -> None:
        failed = any(observation.complaint for observation in found)
        reason = excuse(self._expected, question.name, failed=failed) if found else ""
        for case, complaint, _ in found:
            command = "" if case is ANSWERS else question.command
            if complaint and reason:
                self._tally.excuse(case, command, Cause.NOT_SUPPORTED, reason)
            else:
                text = f"{question.name}: {complaint}" if complaint else ""
                self._tally.observe(case, command, text, evidence)

    def _results(self) -> list[Result]:
        results = self._tally.results()
        for case, ability in ABILITIES.items():
            if ability not in self.greeting.can:
                results.append(_lacking(case, f"it does not offer to report {ability}"))
        return [*results, *outdated(self._expected)]


def _lacking(case: TestCase, reason: str) -> Result:
    cause = Cause.NOT_SUPPORTED
    return Result(case.id, "", cause.verdict, reason, (), case.source, cause)


def _in_words(found: Sequence[Observation]) -> str:
    return ", ".join(o.complaint for o in found if o.complaint) or "no complaint"
