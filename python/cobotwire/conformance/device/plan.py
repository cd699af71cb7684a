"""The steps of a run, and how an earlier report continues or repeats it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.conformance.device.probe import Body
from cobotwire.conformance.report import Cause, Report, Result, Verdict
from cobotwire.conformance.suite import Group
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command


class Step(NamedTuple):
    """A group and the command that it runs for; None: the transport as a whole."""

    group: Group[Body]
    command: Command | None

    @property
    def name(self) -> str:
        """The command and the group, for messages."""
        return f"{self.command.name if self.command else '(transport)'}: {self.group.name}"

    @property
    def place(self) -> tuple[str, str]:
        """The group and the command, as results name them."""
        return self.group.name, self.command.name if self.command else ""


# The verdicts that show that a step was run.
RAN = (Verdict.PASS, Verdict.FAIL)


def _was_not_run(result: Result) -> bool:
    return result.cause is Cause.RUN_ENDED


class Plan:
    """Which steps to run, in which order, and which results to take from an earlier report."""

    def __init__(self, earlier: Report | None = None, *, resume: bool = False) -> None:
        """Plan to run everything, or the steps of a report in their order.

        Args:
            earlier: the report of a run on a device.
            resume: whether to keep its results, and to run only what it did not run.

        Raises:
            UsageError: the report does not say in which steps its results were found.
        """
        self._found: dict[tuple[str, str], list[Result]] = {}
        for result in earlier.results if earlier else ():
            self._found.setdefault((result.group, result.command), []).append(result)
        if earlier is not None and (earlier.kind != "device" or any(not g for g, _ in self._found)):
            message = "this is not the report of a run on a device, or an earlier release wrote it"
            raise UsageError("report", message=message)
        self._resume = resume

    def ordered(self, steps: Sequence[Step]) -> list[Step]:
        """Return the steps in the order of the report."""
        if not self._found:
            return list(steps)
        by_place = {step.place: step for step in steps}
        return [by_place[place] for place in self._found if place in by_place]

    def results(self, step: Step) -> list[Result]:
        """Return the complete results of a step in the earlier report; empty: run the step."""
        return self._found.get(step.place, []) if step.place in self._complete() else []

    def _complete(self) -> set[tuple[str, str]]:
        """Return the steps with complete results; the last before an early end may lack some."""
        whole = [place for place, found in self._found.items() if not any(map(_was_not_run, found))]
        if not self._resume:
            return set()
        ran = [place for place in whole if any(r.verdict in RAN for r in self._found[place])]
        return set(whole) - set(ran[-1:] if len(whole) < len(self._found) else ())
