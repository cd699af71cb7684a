"""One run of a group's body on one command: what the body uses to observe the device."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from cobotwire.conformance.device.device import Device, EnoughFailures, NotSupported
from cobotwire.conformance.device.kept_state import KeptState
from cobotwire.conformance.device.permissions import class_of
from cobotwire.conformance.device.requests import flag_text
from cobotwire.conformance.report import Cause, Result
from cobotwire.conformance.suite import Group, Selects, TestCase
from cobotwire.conformance.tally import Evidence, Tally
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table

# How many exchanges before the first failure are its evidence.
EVIDENCE = 12
# A body ends early once a test case has failed this often: the rest would only repeat it, slowly.
PATIENCE = 3


@dataclass(slots=True)
class Run:
    """What the bodies of a run share: the device, and the state before the first malformed request.

    ``kept`` is set by the groups that send malformed requests; None: no state is compared.
    """

    device: Device
    kept: KeptState | None = None


class Probe:
    """Observes the device, and collects a verdict on each test case of a group."""

    def __init__(self, run: Run, group: Group[Body], command: Command | None, tally: Tally) -> None:
        self.run = run
        self.device = run.device
        self._command = command
        self._tally = tally
        self._name = "" if command is None else command.name
        self._start = run.device.connection.mark
        for case in group.cases:
            if command is None or case.applies(command):
                tally.expect(case, self._name)

    @property
    def command(self) -> Command:
        """The command that is tested."""
        assert self._command is not None, "a group without selects tests no command"
        return self._command

    def expect(self, case: TestCase, holds: bool, reason: str) -> None:
        """Observe whether a test case holds; ``reason`` says what was expected and received.

        Raises:
            EnoughFailures: it has failed so often that the body can end.
        """
        if (case, self._name) in self._tally:
            complaint = "" if holds else reason
            evidence = () if holds else self._evidence()
            failed = self._tally.observe(case, self._name, complaint, evidence)
            if not holds and failed >= PATIENCE:
                raise EnoughFailures

    def expect_flag(
        self, case: TestCase, query: Request[Any], right: bool, call: str = "", when: str = ""
    ) -> None:
        """Observe whether a query reports a flag; by default, its name is the ``call``."""
        command, reported = self.device.table.command(query.command), self.device.is_set(query)
        expected = f"{call or command.name}: expected {flag_text(command, right)}{when}"
        self.expect(case, reported is right, f"{expected}; received {flag_text(command, reported)}")

    def drop(self, case: TestCase) -> None:
        """Give no verdict on a test case that has no meaning for the command."""
        self._tally.drop(case, self._name)

    def note(self, case: TestCase, text: str) -> None:
        """Report this text if the verdict on a test case is pass."""
        self._tally.note(case, self._name, text)

    def not_timed(self, case: TestCase, reason: str) -> None:
        """Give no verdict on a test case that was not observed in time, unless it has failed."""
        if (case, self._name) in self._tally:
            self._tally.excuse(case, self._name, Cause.NOT_TIMED, reason)

    def results(self, unsupported: str = "") -> list[Result]:
        """Return a result for each test case; ``unsupported`` says why nothing was observed."""
        return self._tally.results(evidence=self._evidence(), unobserved=unsupported)

    def without_verdict(self, cause: Cause, reason: str) -> list[Result]:
        """Return the results of a body that was not run; ``reason`` is a sentence."""
        for case in self._tally.cases:
            self._tally.excuse(case, self._name, cause, reason)
        return self._tally.results()

    def _evidence(self) -> Evidence:
        connection = self.device.connection
        return connection.between(self._start, connection.mark, EVIDENCE)


# Exercises the test cases of a group on one command, or on the transport as a whole.
Body = Callable[[Probe], None]
Found = TypeVar("Found")
FoundBody = Callable[[Probe, Found], None]


def for_found(
    find: Callable[[Table, Command], Found | None], body: FoundBody[Found]
) -> tuple[Body, Selects]:
    """Return a body for the commands for which ``find`` finds something, and their selector.

    ``body`` gets what was found.
    """

    def run(probe: Probe) -> None:
        found = find(probe.device.table, probe.command)
        if found is None:
            raise NotSupported("the device lacks a command that this test needs")
        body(probe, found)

    return run, find


def needed(group: Group[Body], command: Command | None) -> frozenset[str]:
    """Return the permissions that a group needs to run for a command."""
    return group.permission | (class_of(command) if command else frozenset())
