"""One run of a group's body on one command: what the body uses to observe the device."""

from __future__ import annotations

from collections.abc import Callable

from cobotwire.conformance.device.device import Device, EnoughFailures
from cobotwire.conformance.device.permissions import class_of
from cobotwire.conformance.report import Cause, Result
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.conformance.tally import Evidence, Tally
from cobotwire.protocol.table import Command

# How many exchanges before the first failure are its evidence.
EVIDENCE = 12
# A body ends early once a test case has failed this often: the rest would only repeat it, slowly.
PATIENCE = 3


class Probe:
    """Observes the device, and collects a verdict on each test case of a group."""

    def __init__(
        self, device: Device, group: Group[Body], command: Command | None, tally: Tally
    ) -> None:
        self.device = device
        self._command = command
        self._tally = tally
        self._name = "" if command is None else command.name
        self._start = device.connection.mark
        for case in group.cases:
            if command is None or case.applies(command):
                tally.expect(case, self._name)

    @property
    def command(self) -> Command:
        """The command that is tested."""
        assert self._command is not None, "a group without selects tests no command"
        return self._command

    def expect(self, case: TestCase, holds: bool, reason: str) -> None:
        """Observe whether a test case holds; ``reason`` says what was expected and what came.

        Raises:
            EnoughFailures: it has failed so often that the body can end.
        """
        if (case, self._name) in self._tally:
            complaint = "" if holds else reason
            evidence = () if holds else self._evidence()
            failed = self._tally.observe(case, self._name, complaint, evidence)
            if not holds and failed >= PATIENCE:
                raise EnoughFailures

    def drop(self, case: TestCase) -> None:
        """Give no verdict on a test case that has no meaning for the command."""
        self._tally.drop(case, self._name)

    def note(self, case: TestCase, text: str) -> None:
        """Report this text if the verdict on a test case is pass."""
        self._tally.note(case, self._name, text)

    def not_timed(self, case: TestCase, reason: str) -> None:
        """Give no verdict on a test case, unless it has failed: the right moment was missed."""
        if (case, self._name) in self._tally:
            self._tally.excuse(case, self._name, Cause.NOT_TIMED, reason)

    def results(self, unsupported: str = "") -> list[Result]:
        """Return a result for each test case; ``unsupported`` says why nothing was observed."""
        return self._tally.results(evidence=self._evidence(), unobserved=unsupported)

    def not_permitted(self, missing: str) -> list[Result]:
        """Return the results of a body that was not run for lack of permission."""
        return self._without_verdict(Cause.NOT_PERMITTED, f"It needs permission: {missing}.")

    def not_selected(self, reason: str) -> list[Result]:
        """Return the results of a body that was not run, because the statement deselects it."""
        return self._without_verdict(Cause.NOT_SELECTED, reason)

    def not_run(self, reason: str) -> list[Result]:
        """Return the results of a body that was not run, because the run ended before."""
        return self._without_verdict(Cause.RUN_ENDED, reason)

    def _without_verdict(self, cause: Cause, reason: str) -> list[Result]:
        for case in self._tally.cases:
            self._tally.excuse(case, self._name, cause, reason)
        return self._tally.results()

    def _evidence(self) -> Evidence:
        connection = self.device.connection
        return connection.between(self._start, connection.mark, EVIDENCE)


# Exercises the test cases of a group on one command, or on the line as a whole.
Body = Callable[[Probe], None]


def needed(group: Group[Body], command: Command | None) -> frozenset[str]:
    """Return the permissions that a group needs to run for a command."""
    return group.permission | (class_of(command) if command else frozenset())
