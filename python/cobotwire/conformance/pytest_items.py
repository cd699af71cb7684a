"""The tests that ``pytest --conform-device`` makes; loaded only with that option."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from cobotwire import editions
from cobotwire.conformance.device import DeviceConnection, RunOptions, Step
from cobotwire.conformance.hex_text import evidence_lines
from cobotwire.conformance.report import Result, Verdict
from cobotwire.conformance.sources import spec_lines
from cobotwire.protocol.printable import printable
from cobotwire.transport import open_transport


class DeviceUnderTest:
    """Runs each step once, for the first of its test cases that pytest runs."""

    def __init__(self, config: pytest.Config) -> None:
        edition = config.getoption("--conform-edition") or editions.DEFAULT
        table = editions.load(edition).TABLE
        options = RunOptions(
            allow=config.getoption("--conform-allow"),
            max_speed=config.getoption("--conform-max-speed"),
            workspace=config.getoption("--conform-workspace"),
        )
        options.validate(table)
        self._transport = open_transport(config.getoption("--conform-device"), table.baudrate)
        connection = DeviceConnection(self._transport)
        self._tester = options.tester(connection, table, spec_lines(edition))
        self._results: dict[int, dict[str, Result]] = {}

    def items(self, session: pytest.Session) -> Iterator[pytest.Item]:
        """Yield a test for each test case and command that the permissions allow."""
        for number, step in enumerate(self._tester.steps()):
            if self._tester.missing(step):
                continue
            for case in step.group.cases:
                if step.command is None or case.applies(step.command):
                    name = f"{step.command.name if step.command else 'line'}::{case.id}"
                    yield ConformItem.of(session, name, self, number, step, case.id)

    def result(self, number: int, step: Step, case: str) -> Result | None:
        """Return the result of a test case; None if it has no meaning for the command."""
        if number not in self._results:
            found = self._tester.results(step)
            self._results[number] = {result.case: result for result in found}
        return self._results[number].get(case)

    def close(self) -> None:
        """Restore what the run has changed, and close the port."""
        self._tester.end()
        self._transport.close()


class NotConforming(Exception):
    """The device fails a test case."""


class ConformItem(pytest.Item):
    """One test case for one command."""

    run_case: Callable[[], Result | None]

    @classmethod
    def of(
        cls,
        parent: pytest.Session,
        name: str,
        device: DeviceUnderTest,
        number: int,
        step: Step,
        case: str,
    ) -> ConformItem:
        """Return the item for a test case of a step."""
        item: ConformItem = cls.from_parent(parent, name=name)
        item.run_case = lambda: device.result(number, step, case)
        return item

    def runtest(self) -> None:
        """Pass, skip or fail, by the verdict."""
        result = self.run_case()
        if result is None or result.verdict is Verdict.INCONCLUSIVE:
            pytest.skip(result.reason if result else "no meaning for this command")
        if result.verdict is not Verdict.PASS:
            raise NotConforming(_in_full(result))

    def repr_failure(
        self, excinfo: pytest.ExceptionInfo[BaseException], style: object = None
    ) -> str:
        """Return the verdict with its evidence; other exceptions as usual."""
        if isinstance(excinfo.value, NotConforming):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[str, int | None, str]:
        """Return the place that pytest's reports show."""
        return "conform", None, self.name


def _in_full(result: Result) -> str:
    reason = printable(f"{result.case} ({result.source}): {result.reason}")
    return "\n".join([reason, *evidence_lines("device", result)])
