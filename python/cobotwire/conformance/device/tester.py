"""A whole run: every trial of every command that is allowed, and a report."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.conformance.device import trials
from cobotwire.conformance.device.asking import Waits
from cobotwire.conformance.device.bench import Bench
from cobotwire.conformance.device.ending import Hopeless, Unsupported
from cobotwire.conformance.device.leave import Leave
from cobotwire.conformance.device.line import Line
from cobotwire.conformance.device.trial import TRIALS, Case, Trial
from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.errors import UsageError
from cobotwire.table import Command, Table

assert trials

Progress = Callable[["Step", int, int], None]


class Step(NamedTuple):
    """A trial of a command; of the line as a whole where there is none."""

    trial: Trial
    command: Command | None

    @property
    def name(self) -> str:
        """For people: the command, and what is tried."""
        return f"{self.command.name if self.command else 'the line'}: {self.trial.name}"


class Tester:
    """Tests the device at the other end of a line against an edition."""

    # So that pytest does not take it for a class of tests where it is imported.
    __test__ = False

    def __init__(
        self,
        line: Line,
        table: Table,
        *,
        leave: Leave | None = None,
        places: Mapping[str, str] | None = None,
        waits: Waits | None = None,
        repeat: int = 1,
        retries: int = 0,
        optional: frozenset[str] = frozenset(),
    ) -> None:
        """Prepare a run; nothing is sent.

        Args:
            line: the line to the device.
            table: the edition that it shall keep to.
            leave: what may be sent beside queries; left out: nothing.
            places: where the spec says each command, by name.
            waits: how long is listened.
            repeat: how often each trial is run; where the runs differ, the verdict is unstable.
            retries: how often a query is asked again where nothing comes.
            optional: commands that the device may lack: silence on them is not supported.
        """
        self.line = line
        self.table = table
        self.repeat = repeat
        self.optional = optional
        self.bench = Bench(
            line,
            codecs.load(table),
            leave=leave or Leave(),
            places=places or {},
            waits=waits or Waits(),
            retries=retries,
        )
        began = datetime.now(UTC).isoformat(timespec="seconds")
        self.report = Report("device", table.edition, line.name, began)
        self.report.reply_seconds = self.bench.reply_seconds
        self.report.deadline_seconds = {c.name: c.deadline_ms / 1000 for c in table.commands}

    def steps(self) -> Iterator[Step]:
        """The trials in the order of a run."""
        for trial in TRIALS:
            if trial.applies is None:
                yield Step(trial, None)
                continue
            for command in self.table.commands:
                if trial.applies(self.table, command):
                    yield Step(trial, command)

    def run(self, progress: Progress | None = None) -> Report:
        """Run everything that is allowed; whatever ends it, what was changed is set back.

        Raises:
            LinkError: the link is gone; the report holds what was found until then.
        """
        steps = list(self.steps())
        try:
            self._ask_version()
            for index, step in enumerate(steps):
                if progress is not None:
                    progress(step, index, len(steps))
                self.report.results += self.results(step)
        except KeyboardInterrupt:
            self._halt()
            raise
        finally:
            self.end()
        self.report.finished = True
        return self.report

    def _halt(self) -> None:
        """Stop the arm; where it is not at rest, it is not sent anywhere."""
        self.bench.undo_last.clear()
        stop = self.bench.command("stop")
        if stop is not None and self.bench.leave.workspace:
            self.bench.ask(stop)

    def end(self) -> None:
        """Set back what is still to be; then what was changed for the whole run: power and pose.

        The arm may be on its way back: an interrupt stops it too.
        """
        try:
            self.bench.set_back(self.bench.undo)
            self.bench.set_back(self.bench.undo_last)
        except KeyboardInterrupt:
            self._halt()
            self.bench.set_back(self.bench.undo)
            raise

    def _ask_version(self) -> None:
        query = self.bench.command("version")
        fields = None if query is None else self.bench.read(query)
        if fields is not None:
            self.report.firmware = str(next(iter(fields.values())))

    def results(self, step: Step) -> list[Result]:
        """Run one step as often as is asked for."""
        missing = self.bench.leave.lacks(step.trial.needs(step.command))
        if missing:
            return Case(self.bench, step.command, step.trial.rules).not_allowed(missing)
        return merged([self._once(step) for _ in range(self.repeat)])

    def _once(self, step: Step) -> list[Result]:
        case = Case(self.bench, step.command, step.trial.rules)
        unsupported = ""
        try:
            step.trial.run(case)
        except Hopeless:
            pass
        except Unsupported as reason:
            unsupported = str(reason)
        except UsageError as error:
            unsupported = f"what the device told cannot be sent to it: {error}"
        except KeyboardInterrupt:
            self._halt()
            raise
        finally:
            self.bench.set_back(self.bench.undo)
        return [self._excused(result) for result in case.results(unsupported)]

    def _excused(self, result: Result) -> Result:
        """A command that the device may lack does not fail by silence."""
        if result.command not in self.optional or result.verdict is not Verdict.FAIL:
            return result
        if self.bench.reply_seconds.get(result.command):
            return result
        return replace(result, verdict=Verdict.NOT_SUPPORTED)


def merged(runs: list[list[Result]]) -> list[Result]:
    """One result a rule; where the runs differ, it is unstable and tells of the worst."""
    found = []
    for same in zip(*runs):
        verdicts = {result.verdict for result in same}
        worst = next((r for r in same if r.verdict is Verdict.FAIL), same[0])
        if len(verdicts) > 1:
            times = sum(result.verdict is worst.verdict for result in same)
            reason = f"{times} of {len(same)} runs: {worst.verdict}. {worst.reason}"
            worst = replace(worst, verdict=Verdict.UNSTABLE, reason=reason)
        found.append(worst)
    return found
