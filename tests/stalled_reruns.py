"""Run a failed test again if the machine stood still meanwhile.

Many tests wait for a real reply within a deadline. If the machine stops for longer than that, once
or in several pieces, the failure says nothing about the code. A stall of one processor counts, and
so does one of pseudo-terminals: either may stop the far end of a line, which is often another
thread or process. A test that fails without a stall fails at once, and one that fails in each run
fails. The summary names the tests that were run again. A test that measures short times is marked
with the stall, in seconds, that makes its failure meaningless: ``@pytest.mark.stall(0.05)``.
"""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any

import pytest
from _pytest.runner import call_and_report

from machine_stalls import MachineStalls, machine_stalls

# Seconds of stalls within a second after which a test is run again: half of a reply's deadline.
STALL = 0.25
RUNS = 3
PERIOD = 0.02
AGAIN = pytest.StashKey[list[str]]()
STALLS = pytest.StashKey[MachineStalls]()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool:
    """Run a test, and report its last run."""
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    reports: list[pytest.TestReport] = []
    for runs_left in reversed(range(RUNS)):
        reports, stall = _run(item, nextitem, last=runs_left == 0)
        if not stall:
            break
        item.config.stash.setdefault(AGAIN, []).append(f"{item.nodeid}: {stall:.2f} s")
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


def _run(
    item: pytest.Item, nextitem: pytest.Item | None, *, last: bool
) -> tuple[list[pytest.TestReport], float]:
    """Run a test once; return its reports, and how long it stalled if it must run again, or 0."""
    function: Any = item
    if not getattr(function, "_request", True):
        function._initrequest()
    stalls = _stalls(item.config)
    stalls.restart()
    reports = [call_and_report(item, "setup", log=False)]
    failed = False
    if reports[0].passed:
        reports.append(call_and_report(item, "call", log=False))
        failed = reports[-1].failed
    stalls.include_current()
    marker = item.get_closest_marker("stall")
    limit = marker.args[0] if marker else STALL
    again = failed and not last and stalls.worst_second > limit
    # Only the test's own fixtures end; shared ones stay for the next run.
    after = item.parent if again else nextitem
    reports.append(call_and_report(item, "teardown", log=False, nextitem=after))
    if hasattr(function, "_request"):
        function._request, function.funcargs = False, None
    return reports, stalls.worst_second if again else 0.0


def _stalls(config: pytest.Config) -> MachineStalls:
    """Return the meters of all tests: to start threads for each takes longer than many tests."""
    if STALLS not in config.stash:
        running = ExitStack()
        config.add_cleanup(running.close)
        config.stash[STALLS] = running.enter_context(machine_stalls(PERIOD))
    return config.stash[STALLS]


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Name the tests that ran again, with the stall of each failed run."""
    for line in config.stash.get(AGAIN, []):
        terminalreporter.write_line(f"run again, because the machine stalled: {line}")
