"""The referee: a simulated arm that checks the client that uses it, and writes a report."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

from cobotwire import codec as codecs
from cobotwire.conformance.client.broken_frames import joined
from cobotwire.conformance.client.delivery import Delivery, faulty_replies, require_possible
from cobotwire.conformance.client.groups.frames import missing_text
from cobotwire.conformance.client.history import History, Received
from cobotwire.conformance.client.script import SCRIPT, Script, ScriptLine
from cobotwire.conformance.client.suite import WITHOUT_SCRIPT
from cobotwire.conformance.report import Cause, Report, Result, Verdict
from cobotwire.conformance.tally import Observation, Tally
from cobotwire.protocol.table import Table
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator.arm import SimulatedArm
from cobotwire.simulator.faults import Scenario

# A round trip to an arm on USB takes 8.3 to 9 ms.
DELAY_SECONDS = 0.008


class Referee:
    """A peer that replies as an arm does and checks every request."""

    def __init__(
        self,
        table: Table,
        *,
        subject: str = "client",
        scenario: Scenario | None = None,
        script: Sequence[ScriptLine] | None = None,
        acks: bool = True,
        patience: float = 0.03,
        sources: Mapping[str, str] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Switch the arm on and wait for requests.

        Args:
            table: the edition that the client must conform to.
            subject: what the report calls the client.
            scenario: how replies are delivered; left out: all of them after 8 ms.
            script: what the client is meant to send, if that is known.
            acks: whether changes are acknowledged, where the edition allows it.
            patience: seconds after which a reply never comes.
            sources: where the spec defines each command, for the report.
            clock: gives the time in seconds.

        Raises:
            UsageError: the edition cannot express a line of the script, or a fault of the scenario.
        """
        scenario = scenario or faulty_replies(DELAY_SECONDS)
        require_possible(scenario, table)
        self._clock = clock
        self._started = clock()
        self._arm = SimulatedArm(
            table, clock=clock, on_event=self._receive, acks=acks, powered=True
        )
        codec = codecs.load(table)
        self._history = History(codec, patience)
        self._delivery = Delivery(scenario, codec, self._now)
        self._due = b""
        self._power = self._powered_devices()
        self._script = None if script is None else Script(codec, script)
        self._tally = Tally(sources)
        # Noise that is not checked yet, because a frame in pieces may not be complete.
        self._pieces: list[Received] = []
        self._last_byte: float | None = None
        self._arrival = 0.0
        self.requests = 0
        self.report = Report("client", table.edition, subject)

    @property
    def silence(self) -> float | None:
        """Seconds since the client's last byte; None: it has sent none."""
        return None if self._last_byte is None else self._now() - self._last_byte

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        waits = [wait for wait in (self._arm.wait, self._delivery.wait) if wait is not None]
        return min(waits, default=None)

    def receive(self, data: bytes) -> bytes:
        """Take bytes from the client; return what is due by now."""
        self._last_byte = self._arrival = self._now()
        self._due += self._arm.take_events()
        self._arm.receive(data)
        return self._take_due()

    def flush(self) -> bytes:
        """Let time pass; return what is due by now."""
        self._arrival = self._now()
        self._due += self._arm.take_events()
        silence = self.silence
        if self._arm.wait is not None and silence is not None and silence >= self._arm.wait:
            self._arm.flush()
        return self._take_due()

    def finish(self) -> Report:
        """Check what is left after the client has disconnected, and close the report."""
        self._arrival = self._now()
        self._arm.flush()
        self._check_noise()
        if self._script is not None:
            for observation in self._script.end():
                self._observe(observation)
        due = self._history.missing_text()
        if due is not None:
            self._observe(missing_text(due), due)
        if not self.requests and not self.report.stopped:
            self.report.stopped = "the client sent no request"
        self.report.finished = not self.report.stopped
        self.report.seconds = self._now()
        self.report.results = [*self._tally.results(), *self._script_results()]
        return self.report

    def _now(self) -> float:
        return self._clock() - self._started

    def _take_due(self) -> bytes:
        due, self._due = self._due + self._delivery.due(), b""
        return due

    def _receive(self, event: DeviceEvent, reply: bytes) -> None:
        # Dated by arrival: the time that the arm takes to compute a reply must not count.
        now = Received(self._arrival, event, reply)
        if now.noise is not None:
            self._pieces.append(now)
        else:
            self._check_noise()
            self._check(now)
        self._due += self._delivery.plan(now)

    def _check_noise(self) -> None:
        """Check the noise so far, as whole broken frames."""
        pieces, self._pieces = self._pieces, []
        for whole in joined(pieces):
            self._check(whole)

    def _check(self, now: Received) -> None:
        self._history.powered, self._history.released = self._power_of(now)
        for group in WITHOUT_SCRIPT:
            for observation in group.body(self._history, now):
                self._observe(observation, now)
        if self._script is not None:
            for observation in self._script.check(now):
                self._observe(observation, now)
        self._history.entries.append(now)
        self._power = self._powered_devices()
        if now.command is not None:
            self.requests += 1

    def _powered_devices(self) -> dict[int | None, tuple[bool, bool]]:
        """Return for each device whether it has power, and whether it then holds no joint."""
        return {
            address: (state.powered, state.powered and not any(state.enabled))
            for address, state in self._arm.states.items()
        }

    def _power_of(self, now: Received) -> tuple[bool, bool]:
        """Return whether any receiver of a request had power, and whether none held a joint."""
        address = self._arm.table.frame.address(now.data) if now.is_frame else None
        powered, released = zip(*(self._power[each] for each in self._arm.receivers(address)))
        return any(powered), all(released)

    def _observe(self, observation: Observation, now: Received | None = None) -> None:
        case, complaint, command = observation
        name = (now.name if now else "") if command is None else command
        if complaint:
            evidence = self._history.evidence(now) if now else ()
            self._tally.observe(case, name, complaint, evidence)
        elif name:
            # Only requests have a row in the report; a legal text has none.
            self._tally.observe(case, name)

    def _script_results(self) -> list[Result]:
        """Return a result for each test case of the script that has no failure.

        Failures are reported by command.
        """
        results = []
        for case in SCRIPT.cases:
            if self._script is None:
                reason, cause = f"{case.purpose} It needs a script (--expect).", Cause.NOT_SELECTED
                result = Result(case.id, "", cause.verdict, reason, cause=cause)
                results.append(result)
            elif case not in self._tally.cases:
                results.append(Result(case.id, "", Verdict.PASS, case.purpose))
        return results
