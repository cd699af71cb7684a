"""The suite of the referee: broken and correct clients, with or without a script."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.client import (
    FAULTS,
    Referee,
    ScriptLine,
    faulty_replies,
    possible_faults,
)
from cobotwire.conformance.client.referee import DELAY_SECONDS
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import Scenario
from mutation.client.frames import wrong_frames, wrong_times, wrong_turns
from mutation.client.mutant import PAUSE, ClientMutant, Sent
from mutation.client.sessions import sessions
from mutation.client.values import wrong_values
from mutation.suite import Case, Outcome, RightRun

RUNS = 20


class ClientSuite:
    """See :class:`mutation.suite.Suite`."""

    def __init__(self, table: Table, with_script: bool) -> None:
        self._table = table
        self._with_script = with_script
        self._mutants = {mutant.id: mutant for mutant in client_mutants(table)}
        self._codec = ReferenceCodec(table)
        how = "with" if with_script else "without"
        self.name = f"client {how} a script, {table.edition}"

    def cases(self) -> Sequence[Case]:
        """Return every mutant of a client of the edition."""
        return [Case(mutant.id, mutant.kind) for mutant in self._mutants.values()]

    def judge(self, case: Case) -> Outcome:
        """Let the referee judge a mutant."""
        mutant = self._mutants[case.id]
        scenario = faulty_replies(DELAY_SECONDS, ("lost",), 1) if mutant.lost else None
        found = first_failure(
            self._table, mutant.writes, mutant.script if self._with_script else None, scenario
        )
        return Outcome(case, found, "" if found else self._reason(mutant))

    def right_runs(self) -> Sequence[str]:
        """Return the names of a correct client's runs: on good lines and with each fault."""
        lines = ("good", "no-acks", *possible_faults(self._table))
        return [f"{lines[number % len(lines)]} {number}" for number in range(RUNS)]

    def accept(self, run: str) -> RightRun:
        """Let the referee judge a correct client: every request once, in a random order."""
        line, number = run.split()
        every = sessions(self._table)
        off = [s for s in every if s.command.safety == "power"]
        every = [s for s in every if s not in off]
        Random(int(number)).shuffle(every)
        scenario = faulty_replies(DELAY_SECONDS, [line], 2) if line in FAULTS else None
        writes = tuple(Sent(PAUSE, s.frame + s.text) for s in every)
        script = [s.script()[1] for s in every] if self._with_script else None
        found = first_failure(self._table, writes, script, scenario, acks=line != "no-acks")
        return RightRun(run, not found, found)

    def _reason(self, mutant: ClientMutant) -> str:
        """Return why a mutant without a script cannot be found; empty if it can."""
        if self._with_script:
            return ""
        # Two correct requests may change places; the text after one of them is not a frame.
        if mutant.kind != "swapped" and not all(map(self._legal, mutant.writes)):
            return ""
        if mutant.kind in ("repeated too soon", "reply not awaited", "late reply", "unpowered"):
            return ""
        repeats = [sent for sent in mutant.writes if len(sent.data) and sent.after < PAUSE]
        if repeats and mutant.kind != "resent":
            return ""
        return (
            "legal requests at allowed times; without a script, the intended requests are unknown"
        )

    def _legal(self, sent: Sent) -> bool:
        framer = self._codec.framer("request")
        events = [*framer.feed(sent.data), *framer.flush()]
        try:
            for event in events:
                self._codec.decode("request", event.data)
        except ProtocolError:
            return False
        return True


def client_mutants(table: Table) -> list[ClientMutant]:
    """Return every mutant of a client in a fixed order, with unique ids."""
    every = sessions(table)
    found = [
        mutant
        for session in every
        for make in (wrong_values, wrong_frames, wrong_times)
        for mutant in make(session)
    ]
    return [*found, *wrong_turns(table, every)]


def first_failure(
    table: Table,
    writes: Sequence[Sent],
    script: Sequence[ScriptLine] | None,
    scenario: Scenario | None,
    acks: bool = True,
) -> str:
    """Return the first failure that the referee reports; empty if there is none."""
    clock = SteppedClock()
    referee = Referee(table, scenario=scenario, script=script, acks=acks, clock=clock)
    for sent in writes:
        _pass_time(referee, clock, sent.after)
        if sent.data:
            referee.receive(sent.data)
    _pass_time(referee, clock, PAUSE)
    report = referee.finish()
    return next((f"{result.case}: {result.reason}" for result in report.failures), "")


def _pass_time(referee: Referee, clock: SteppedClock, seconds: float) -> None:
    """Let time pass as a server does, which flushes the referee whenever it is due."""
    end = clock() + seconds
    while referee.wait is not None and clock() + referee.wait <= end:
        clock.sleep(referee.wait)
        referee.flush()
    clock.sleep(end - clock())
