"""The report of every tester: verdicts, each with its reason and the bytes as evidence."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import UTC, datetime
from enum import StrEnum
from typing import Literal, NamedTuple

Kind = Literal["device", "client", "codec"]
Direction = Literal["sent", "received"]


class Verdict(StrEnum):
    """What a test case found, in the words of ISO/IEC 9646; or that it was not run."""

    PASS = "pass"  # noqa: S105  (a verdict, not a password)
    FAIL = "fail"
    INCONCLUSIVE = "inconclusive"
    # Without a verdict: nothing was sent for the test case, or not all of it.
    NOT_RUN = "not run"


class Cause(StrEnum):
    """Why a test case was inconclusive or not run, or the kind of a failure."""

    NONE = ""
    # Not run: the run lacks the permission for what must be sent.
    NOT_PERMITTED = "not permitted"
    # Not run: the statement of the subject, or the options of the run, deselect the test case.
    NOT_SELECTED = "not selected"
    # Not run: the run ended first.
    RUN_ENDED = "run ended"
    # Inconclusive: the subject lacks what the test case is about, or is in the wrong state.
    NOT_SUPPORTED = "not supported"
    # Inconclusive: a state had ended before it could be observed, or the host was late.
    NOT_TIMED = "not timed"
    # Fail: repetitions of the same test case differ.
    UNSTABLE = "unstable"

    @property
    def verdict(self) -> Verdict:
        """The verdict that goes with the cause, if nothing else has failed."""
        return OF_CAUSE.get(self, Verdict.NOT_RUN)


OF_CAUSE = {
    Cause.NONE: Verdict.PASS,
    Cause.NOT_SUPPORTED: Verdict.INCONCLUSIVE,
    Cause.NOT_TIMED: Verdict.INCONCLUSIVE,
    Cause.UNSTABLE: Verdict.FAIL,
}


class Exchange(NamedTuple):
    """Bytes on the line, ``sent`` or ``received`` by the tester.

    ``at`` is seconds since the run started.
    """

    at: float
    direction: Direction
    data: bytes
    note: str = ""


@dataclass(frozen=True, slots=True)
class Result:
    """The verdict of one test case on one command.

    ``command`` is empty if the test case is about the transport as a whole. ``case`` is its id,
    ``source`` where the requirement is stated (``spec/commands/motion.yaml:12``),
    ``reason`` a sentence that states what was expected and received. ``further`` has the reasons
    of later failures of the test case on the command; ``reason`` says how many there were.
    ``group`` is the group of test cases that was run; empty if the subject's groups are checked
    together. ``load`` is the host's load average divided by the number of its processors, if the
    verdict depends on time; 0: it does not, or the load is unknown.
    """

    case: str
    command: str
    verdict: Verdict
    reason: str
    evidence: tuple[Exchange, ...] = ()
    source: str = ""
    cause: Cause = Cause.NONE
    further: tuple[str, ...] = ()
    group: str = ""
    load: float = 0.0

    @property
    def explained(self) -> str:
        """The reason, with the load of the host if that may be a cause."""
        beside = self.load and self.verdict is not Verdict.PASS
        return f"{self.reason} (host load {self.load:.2f} per processor)" if beside else self.reason

    @property
    def outcome(self) -> str:
        """The verdict with its cause: ``not run (not permitted)``."""
        return f"{self.verdict} ({self.cause})" if self.cause else str(self.verdict)


@dataclass(frozen=True, slots=True)
class Environment:
    """The machine and the programs of a run; ``port`` is the port or program of the subject.

    ``host`` is a hash of the machine's name, which often is a person's.
    """

    host: str = ""
    system: str = ""
    python: str = ""
    package: str = ""
    codec: str = ""
    port: str = ""


@dataclass(frozen=True, slots=True)
class Host:
    """How long a run took by two clocks of the host, and the load average per processor.

    The times of a report are those of the monotonic clock. A load of 0 is unknown.
    """

    monotonic_seconds: float = 0.0
    wall_seconds: float = 0.0
    load_at_start: float = 0.0
    load_at_end: float = 0.0


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


@dataclass(slots=True)
class Report:
    """The results of a run, in the order in which they were found.

    ``finished`` is False until the run has reached its end; ``stopped`` says why it ended before.
    ``untested`` says what the run could not show, and which permission would show it.
    ``options`` are the command-line options except the subject; ``--again`` reuses them, and runs
    the test cases in the order of ``results``. ``statement`` is the text of the subject's
    implementation conformance statement. ``catalogue`` is the version of the catalogue of test
    cases; the digests are those of the edition's table and of the code that checks. ``clauses`` has
    the number of each test case in the catalogue. ``tester`` is who is responsible for the run,
    ``serial`` a hash of the device's serial number.
    """

    kind: Kind
    edition: str
    subject: str
    started: str = field(default_factory=_now)
    firmware: str = ""
    finished: bool = False
    results: list[Result] = field(default_factory=list)
    reply_seconds: dict[str, list[float]] = field(default_factory=dict)
    deadline_seconds: dict[str, float] = field(default_factory=dict)
    stopped: str = ""
    untested: str = ""
    options: dict[str, str] = field(default_factory=dict)
    statement: str = ""
    catalogue: str = ""
    edition_digest: str = ""
    code_digest: str = ""
    clauses: dict[str, int] = field(default_factory=dict)
    tester: str = ""
    serial: str = ""
    environment: Environment = field(default_factory=Environment)
    host: Host = field(default_factory=Host)
    seconds: float = 0.0

    @property
    def failures(self) -> list[Result]:
        """The results with the verdict fail."""
        return [result for result in self.results if result.verdict is Verdict.FAIL]

    @property
    def conforms(self) -> bool:
        """Whether the run reached its end without a failure."""
        return self.finished and not self.failures
