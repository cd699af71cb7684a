"""The referee's suite: clients broken in one place, and right ones, with a script or without."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.client import MISDEEDS, Manners, Referee, Told
from cobotwire.conformance.client.referee import DELAY_SECONDS
from cobotwire.conformance.report import Verdict
from cobotwire.errors import ProtocolError
from cobotwire.sim.clock import SteppedClock
from cobotwire.table import Table
from mutation.client.frames import wrong_frames, wrong_times, wrong_turns
from mutation.client.mutant import PAUSE, ClientMutant, Sent
from mutation.client.sessions import sessions
from mutation.client.values import wrong_values
from mutation.suite import Case, Outcome, Trial

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
        """Every mutant of a client of the edition."""
        return [Case(mutant.id, mutant.kind) for mutant in self._mutants.values()]

    def judge(self, case: Case) -> Outcome:
        """Let the referee hear it."""
        mutant = self._mutants[case.id]
        manners = Manners(DELAY_SECONDS, ("lost",), 1) if mutant.lost else None
        found = heard(
            self._table, mutant.writes, mutant.told if self._with_script else None, manners
        )
        return Outcome(case, found, "" if found else self._reason(mutant))

    def trials(self) -> Sequence[str]:
        """Right clients on good lines, and on each kind of bad one."""
        lines = ("good", "no-acks", *MISDEEDS)
        return [f"{lines[number % len(lines)]} {number}" for number in range(RUNS)]

    def accept(self, trial: str) -> Trial:
        """Let the referee hear a right client: every request once, in an order drawn by lot."""
        line, number = trial.split()
        every = sessions(self._table)
        off = [s for s in every if s.command.safety == "power"]
        every = [s for s in every if s not in off]
        Random(int(number)).shuffle(every)  # noqa: S311  (it must repeat)
        manners = Manners(DELAY_SECONDS, [line], 2) if line in MISDEEDS else None
        writes = tuple(Sent(PAUSE, s.frame + s.behind) for s in every)
        told = [s.told()[1] for s in every] if self._with_script else None
        found = heard(self._table, writes, told, manners, acks=line != "no-acks")
        return Trial(trial, not found, found)

    def _reason(self, mutant: ClientMutant) -> str:
        """Without a script nobody knows what was meant: legal frames, each at a fair time."""
        if self._with_script:
            return ""
        # Two right requests in another order; the text behind one of them is no frame.
        if mutant.kind != "changed over" and not all(map(self._legal, mutant.writes)):
            return ""
        if mutant.kind in ("asked too soon", "reply not awaited", "reply owed", "unpowered"):
            return ""
        orders = [sent for sent in mutant.writes if len(sent.data) and sent.after < PAUSE]
        if orders and mutant.kind != "resent":
            return ""
        return "legal requests at fair times; without a script nobody knows what was meant"

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
    """Every mutant of a client, in a fixed order; no two ids are alike."""
    every = sessions(table)
    found = [
        mutant
        for session in every
        for make in (wrong_values, wrong_frames, wrong_times)
        for mutant in make(session)
    ]
    return [*found, *wrong_turns(table, every)]


def heard(
    table: Table,
    writes: Sequence[Sent],
    told: Sequence[Told] | None,
    manners: Manners | None,
    acks: bool = True,
) -> str:
    """The first rule that the referee finds broken; empty if none is."""
    clock = SteppedClock()
    referee = Referee(table, manners=manners, script=told, acks=acks, clock=clock)
    for sent in writes:
        _pass(referee, clock, sent.after)
        if sent.data:
            referee.receive(sent.data)
    _pass(referee, clock, PAUSE)
    report = referee.finish()
    broken = (result for result in report.results if result.verdict is Verdict.FAIL)
    return next((f"{result.rule}: {result.reason}" for result in broken), "")


def _pass(referee: Referee, clock: SteppedClock, seconds: float) -> None:
    """Let time pass as a server does: it wakes the referee when that asks for it."""
    end = clock() + seconds
    while referee.wait is not None and clock() + referee.wait <= end:
        clock.sleep(referee.wait)
        referee.flush()
    clock.sleep(end - clock())
