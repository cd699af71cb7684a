"""``pytest --conform-device URL``: every rule for every command of an edition is a test.

pytest --conform-device /dev/ttyUSB0 --conform-edition mycobot280 --conform-allow setting
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from cobotwire import editions
from cobotwire.conformance.device import Leave, Line, Step, Tester, words, workspace_of
from cobotwire.conformance.places import places_of
from cobotwire.conformance.report import Result, Verdict
from cobotwire.errors import CobotwireError
from cobotwire.transport import open_link

HELP = "Conformance of a device (cobotwire)"


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options; without the first of them nothing is collected."""
    group = parser.getgroup("conform", HELP)
    group.addoption("--conform-device", metavar="URL", help="Test the device at URL.")
    group.addoption("--conform-edition", default=editions.DEFAULT, help="The edition.")
    group.addoption("--conform-allow", default="", help="Classes of leave, with commas.")
    group.addoption("--conform-max-speed", type=int, help="Percent; motion needs it.")
    group.addoption("--conform-workspace", help="LOW:HIGH in degrees; motion needs it.")


def pytest_collection_modifyitems(
    session: pytest.Session, config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Add the tests of the device behind the others."""
    if config.getoption("--conform-device"):
        try:
            device = _Device(config)
        except CobotwireError as error:
            raise pytest.UsageError(str(error)) from error
        config.add_cleanup(device.close)
        items.extend(device.items(session))


class _Device:
    """The device under test; each step is run once, whichever of its rules is asked for first."""

    def __init__(self, config: pytest.Config) -> None:
        edition = config.getoption("--conform-edition")
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
        cls, parent: pytest.Session, name: str, device: _Device, number: int, step: Step, rule: str
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
