"""Real clients play whole sessions over a pty and TCP, as in bench/client_findings.py."""

from __future__ import annotations

from functools import partial

import pytest

import npm_package
import probe
from client_findings import LINES, Line, checked
from cobotwire.conformance import Report
from machine_stalls import PtyMeter
from stalls import unstalled
from targets.typescript.comparison import package

# A client repeats a query after about 170 ms. A referee that pauses for that long receives both
# requests at once.
ALLOWED_STALL = 0.1


def report_on_time(client: str, line: Line) -> tuple[Report, list[str]]:
    """Run the session; run it again if the machine or its ptys stalled long enough to matter."""
    return unstalled(partial(checked, client, line), ALLOWED_STALL, PtyMeter)


OURS = ["cobotwire", "cobotwire tcp", "cobotwire asyncio", "cobotwire asyncio tcp"]
# bench/client_findings.py runs them on every line.
RUST = [("cobotwire rust", "merged"), ("cobotwire rust async tcp", "noise")]


@pytest.mark.parametrize("client", OURS)
@pytest.mark.parametrize("line", ["good", "no-acks"])
def test_our_client_passes_on_a_good_line(client: str, line: str) -> None:
    report, failures = report_on_time(client, LINES[line])
    assert report.failures == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.parametrize("line", ["lost", "late", "merged", "noise", "split"])
def test_our_client_passes_on_a_bad_line(line: str) -> None:
    report, failures = report_on_time("cobotwire", LINES[line])
    assert report.failures == []
    assert (report.conforms, failures) == (True, [])


@probe.needed
@pytest.mark.parametrize(("client", "line"), RUST)
def test_rust_client_passes(client: str, line: str) -> None:
    report, failures = report_on_time(client, LINES[line])
    assert report.failures == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())
@pytest.mark.parametrize("line", ["good", "merged", "noise"])
def test_client_in_node_passes(line: str) -> None:
    package()
    report, failures = report_on_time("cobotwire node tcp", LINES[line])
    assert report.failures == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
def test_pymycobot_on_a_good_line_fails_only_by_rounding() -> None:
    report, failures = checked("pymycobot", LINES["good"])
    found = {(r.case, r.command) for r in report.failures}
    assert found == {("sent-rounded", "send_radians"), ("sent-rounded", "send_coord")}
    assert failures == []
