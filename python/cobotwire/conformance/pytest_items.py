"""The tests that ``pytest --conform-device`` makes; loaded when the option is there alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from cobotwire import editions
from cobotwire.conformance.device import Leave, Line, Step, Tester, words, workspace_of
from cobotwire.conformance.places import places_of
from cobotwire.conformance.report import Result, Verdict
from cobotwire.transport import open_link


class DeviceUnderTest:
    """The device under test; each step is run once, whichever of its rules is asked for first."""

    def __init__(self, config: pytest.Config) -> None:
        edition = config.getoption("--conform-edition") or editions.DEFAULT
        table = editions.load(edition).TABLE
        space = config.getoption("--conform-workspace")
        leave = Leave.of(
            words(config.getoption("--conform-allow")),
            joints=table.joints,
            max_speed=config.getoption("--conform-max-speed"),
            workspace=None if space is None else workspace_of(space, table.joints),
        )
        self._link = open_link(config.getoption("--conform-device"), table.baudrate)
        self._tester = Tester(Line(self._link), table, leave=leave, places=places_of(edition))
        self._results: dict[int, dict[str, Result]] = {}

    def items(self, session: pytest.Session) -> Iterator[pytest.Item]:
        """A test for each rule and command that there is leave for."""
        for number, step in enumerate(self._tester.steps()):
            if self._tester.bench.leave.lacks(step.trial.needs(step.command)):
                continue
            for rule in step.trial.rules:
                if step.command is None or rule.of(step.command):
                    name = f"{step.command.name if step.command else 'line'}::{rule.id}"
                    yield ConformItem.of(session, name, self, number, step, rule.id)

    def result(self, number: int, step: Step, rule: str) -> Result | None:
        """What a rule says of a command; None where it has no meaning for it."""
        if number not in self._results:
            found = self._tester.results(step)
            self._results[number] = {result.rule: result for result in found}
        return self._results[number].get(rule)

    def close(self) -> None:
        """Set back what the run has changed, and give the port back."""
        self._tester.end()
        self._link.close()


class NotConforming(Exception):
    """The device breaks a rule."""


class ConformItem(pytest.Item):
    """One rule for one command."""

    ask: Callable[[], Result | None]

    @classmethod
    def of(
        cls,
        parent: pytest.Session,
        name: str,
        device: DeviceUnderTest,
        number: int,
        step: Step,
        rule: str,
    ) -> ConformItem:
        """Make one."""
        item: ConformItem = cls.from_parent(parent, name=name)
        item.ask = lambda: device.result(number, step, rule)
        return item

    def runtest(self) -> None:
        """Pass, skip or fail, as the verdict says."""
        result = self.ask()
        if result is None or result.verdict is Verdict.NOT_SUPPORTED:
            pytest.skip(result.reason if result else "the rule has no meaning for this command")
        if result.verdict is not Verdict.PASS:
            raise NotConforming(_told(result))

    def repr_failure(
        self, excinfo: pytest.ExceptionInfo[BaseException], style: object = None
    ) -> str:
        """The verdict with its evidence; our own faults as usual."""
        if isinstance(excinfo.value, NotConforming):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[str, int | None, str]:
        """Where it stands, for reports."""
        return "conform", None, self.name


def _told(result: Result) -> str:
    lines = [f"{result.rule} ({result.source}): {result.reason}"]
    lines += [f"  {e.at:9.4f} {e.direction:5} {e.data.hex(' ').upper()}" for e in result.evidence]
    return "\n".join(lines)
