"""What every tester reports: results with their rule, its source, and the bytes that show it."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Literal

Kind = Literal["device", "client", "codec"]
Direction = Literal["sent", "heard"]


class Verdict(StrEnum):
    """What became of a test."""

    PASS = "pass"  # noqa: S105  (a verdict, not a password)
    FAIL = "fail"
    # The caller gave no leave for what the test must send.
    NOT_ALLOWED = "not allowed"
    # The subject does not have what the test is about.
    NOT_SUPPORTED = "not supported"
    # Repetitions of the same test differ.
    UNSTABLE = "unstable"


@dataclass(frozen=True, slots=True)
class Exchange:
    """Bytes that went over the line: from the tester's side ``sent`` or ``heard``.

    ``at`` is seconds since the run began.
    """

    at: float
    direction: Direction
    data: bytes
    note: str = ""


@dataclass(frozen=True, slots=True)
class Result:
    """One test of one command; ``command`` is empty where a rule is about the line as a whole.

    ``rule`` is the rule's id (``reply-range``), ``source`` where the spec says so
    (``spec/commands/motion.yaml:12``), ``reason`` a sentence for people: what was expected, and
    what came.
    """

    rule: str
    command: str
    verdict: Verdict
    reason: str
    evidence: tuple[Exchange, ...] = ()
    source: str = ""


@dataclass(slots=True)
class Report:
    """A run. ``finished`` is False until its end, so that an interrupted one says what it is."""

    kind: Kind
    edition: str
    subject: str
    began: str
    firmware: str = ""
    finished: bool = False
    results: list[Result] = field(default_factory=list)
    reply_seconds: dict[str, list[float]] = field(default_factory=dict)
    deadline_seconds: dict[str, float] = field(default_factory=dict)

    @property
    def conforms(self) -> bool:
        """Whether the run went to its end and nothing failed."""
        bad = (Verdict.FAIL, Verdict.UNSTABLE)
        return self.finished and not any(result.verdict in bad for result in self.results)
