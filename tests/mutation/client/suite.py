"""The suites of the referee: broken and correct clients, with or without a script."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
from mutation.client.sessions import PAUSE, ClientMutant, Sent, sessions
from mutation.client.values import wrong_values
from mutation.suite import Suite
from playing import play

RUNS = 20


class ClientSuite(Suite):
    """Broken clients, and a correct one on good lines and with each fault.

    Without a script, the referee checks only whether requests are legal.
    """

    def __init__(self, table: Table, *, with_script: bool = True) -> None:
        super().__init__(table, client_mutants(table))
        self._with_script = with_script
        self._codec = ReferenceCodec(table)
        lines = ("good", "no-acks", *possible_faults(table))
        self.right_runs = [f"{lines[number % len(lines)]} {number}" for number in range(RUNS)]

    def killer(self, mutant: ClientMutant) -> str:
        """Run the referee with a mutant."""
        scenario = faulty_replies(DELAY_SECONDS, ("lost",), 1) if mutant.lost else None
        return self._first_failure(mutant.writes, mutant.script, scenario)

    def failure(self, run: str) -> str:
        """Run the referee with a correct client: every request once, in a random order."""
        line, number = run.split()
        every = [s for s in sessions(self.table) if s.command.safety != "power"]
        Random(int(number)).shuffle(every)
        scenario = faulty_replies(DELAY_SECONDS, [line], 2) if line in FAULTS else None
        writes = [Sent(PAUSE, session.whole) for session in every]
        script = [session.line for session in every]
        return self._first_failure(writes, script, scenario, acks=line != "no-acks")

    def reason(self, mutant: ClientMutant) -> str:
        """Return why a mutant without a script cannot be found; empty if it can."""
        if self._with_script:
            return ""
        # The referee accepts two correct requests in another order, and ignores a text after one.
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

    def _first_failure(
        self,
        writes: Sequence[Sent],
        script: Sequence[ScriptLine],
        scenario: Scenario | None,
        acks: bool = True,
    ) -> str:
        clock = SteppedClock()
        referee = Referee(
            self.table,
            scenario=scenario,
            script=script if self._with_script else None,
            acks=acks,
            clock=clock,
        )
        play(referee, clock, [*writes, Sent(PAUSE, b"")])
        report = referee.finish()
        return next((f"{result.case}: {result.reason}" for result in report.failures), "")


def client_mutants(table: Table) -> Iterator[ClientMutant]:
    """Yield every mutant of a client in a fixed order, with unique ids."""
    every = sessions(table)
    for session in every:
        for make in (wrong_values, wrong_frames, wrong_times):
            yield from make(session)
    yield from wrong_turns(every)
