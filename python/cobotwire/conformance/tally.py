"""Counts observations, and turns them into results; the same for every subject."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from cobotwire.conformance.host import load
from cobotwire.conformance.report import Cause, Exchange, Result, Verdict
from cobotwire.conformance.suite import TestCase

Evidence = tuple[Exchange, ...]


class Observation(NamedTuple):
    """One check of a test case; an empty ``complaint`` means that it was met.

    ``command`` is the command that it is about; None: the command of the checked request.
    """

    case: TestCase
    complaint: str = ""
    command: str | None = None


# How many failures after the first a result describes; it counts all of them.
FURTHER = 7
NOTHING_OBSERVED = "nothing was observed that could be checked"


@dataclass(slots=True)
class _Count:
    """What was observed of one test case on one command.

    ``reason`` and ``evidence`` are those of the first failure, ``further`` the next reasons.
    """

    observed: int = 0
    failed: int = 0
    reason: str = ""
    evidence: Evidence = ()
    further: list[str] = field(default_factory=list)
    note: str = ""
    # Why there is no verdict, if nothing is observed.
    otherwise: str = ""
    # Why there is no verdict even if something was observed, or why repetitions disagree.
    excuse: str = ""
    cause: Cause = Cause.NONE


class Tally:
    """The observations of a run, by test case and command."""

    def __init__(self, sources: Mapping[str, str] | None = None) -> None:
        """Start without observations; ``sources`` says where the spec defines each command."""
        self._sources = sources or {}
        self._counts: dict[tuple[TestCase, str], _Count] = {}

    def __contains__(self, place: tuple[TestCase, str]) -> bool:
        """Whether a verdict is given on a test case and command."""
        return place in self._counts

    @property
    def cases(self) -> set[TestCase]:
        """The test cases on which a verdict is given."""
        return {case for case, _ in self._counts}

    @property
    def failed(self) -> bool:
        """Whether any observation failed."""
        return any(count.failed for count in self._counts.values())

    def expect(self, case: TestCase, command: str = "", otherwise: str = "") -> None:
        """Report the test case even without observations; then ``otherwise`` is the reason."""
        count = self._count(case, command)
        count.otherwise = otherwise or count.otherwise

    def drop(self, case: TestCase, command: str = "") -> None:
        """Give no verdict on the test case: it has no meaning for this command."""
        self._counts.pop((case, command), None)

    def observe(
        self, case: TestCase, command: str = "", complaint: str = "", evidence: Evidence = ()
    ) -> int:
        """Count an observation, failed if there is a complaint; return the failures so far."""
        count = self._count(case, command)
        count.observed += 1
        if complaint:
            count.failed += 1
            if count.failed == 1:
                count.reason, count.evidence = complaint, evidence
            elif len(count.further) < FURTHER:
                at = f"at {evidence[-1].at:.3f} s: " if evidence else ""
                count.further.append(at + complaint)
        return count.failed

    def note(self, case: TestCase, command: str, text: str) -> None:
        """Report this text if the verdict is pass."""
        self._count(case, command).note = text

    def excuse(self, case: TestCase, command: str, cause: Cause, reason: str) -> None:
        """Report why there is no verdict; with the cause unstable, report a failure."""
        count = self._count(case, command)
        count.excuse, count.cause = reason, cause

    def results(self, *, evidence: Evidence = (), unobserved: str = "") -> list[Result]:
        """Return a result for each test case and command, in the order of their first mention.

        ``evidence`` belongs to what passed; ``unobserved`` explains why nothing was observed.
        """
        return [
            self._result(case, command, count, evidence, unobserved)
            for (case, command), count in self._counts.items()
        ]

    def _count(self, case: TestCase, command: str) -> _Count:
        return self._counts.setdefault((case, command), _Count())

    def _result(
        self, case: TestCase, command: str, count: _Count, evidence: Evidence, unobserved: str
    ) -> Result:
        source = self._sources.get(command) or case.source
        timed = case.timed or count.cause is Cause.NOT_TIMED
        shown = load() if timed and (count.observed or count.excuse) else 0.0
        result = Result(
            case.id, command, Verdict.INCONCLUSIVE, count.excuse, (), source, load=shown
        )
        if count.failed:
            often = f" ({count.failed} of {count.observed} failed)" if count.observed > 1 else ""
            return replace(
                result,
                verdict=Verdict.FAIL,
                reason=count.reason + often,
                evidence=count.evidence,
                further=tuple(count.further),
            )
        if count.excuse:
            return replace(result, verdict=count.cause.verdict, cause=count.cause)
        if not count.observed:
            reason = count.otherwise or unobserved or NOTHING_OBSERVED
            return replace(result, reason=reason, cause=Cause.NOT_SUPPORTED)
        often = "once" if count.observed == 1 else f"{count.observed} times"
        reason = count.note or f"Observed {often}."
        return replace(result, verdict=Verdict.PASS, reason=reason, evidence=evidence)


def merged(runs: list[list[Result]]) -> list[Result]:
    """Merge repetitions of the same test cases; where they differ, the verdict is unstable."""
    found = []
    for same in zip(*runs):
        worst = next((r for r in same if r.verdict is Verdict.FAIL), same[0])
        if len({result.outcome for result in same}) > 1:
            often = sum(result.verdict is worst.verdict for result in same)
            reason = f"{often} of {len(same)} runs: {worst.outcome}. {worst.reason}"
            worst = replace(worst, verdict=Verdict.FAIL, cause=Cause.UNSTABLE, reason=reason)
        found.append(worst)
    return found
