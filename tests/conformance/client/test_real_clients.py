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


OURS = ("cobotwire", "cobotwire tcp", "cobotwire asyncio", "cobotwire asyncio tcp")
NODE = pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())
# bench/client_findings.py runs every client on every line.
RUNS = [
    *((client, line) for client in OURS for line in ("good", "no-acks")),
    *(("cobotwire", line) for line in ("lost", "late", "merged", "noise", "split")),
    pytest.param("cobotwire rust", "merged", marks=probe.needed),
    pytest.param("cobotwire rust async tcp", "noise", marks=probe.needed),
    *(pytest.param("cobotwire node tcp", line, marks=NODE) for line in ("good", "merged", "noise")),
]


@pytest.mark.parametrize(("client", "line"), RUNS)
def test_our_client_passes_on_good_and_bad_lines(client: str, line: str) -> None:
    if "node" in client:
        package()
    report, failures = report_on_time(client, LINES[line])
    assert report.failures == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
def test_pymycobot_on_a_good_line_fails_only_by_rounding() -> None:
    report, failures = checked("pymycobot", LINES["good"])
    found = {(r.case, r.command) for r in report.failures}
    assert found == {("sent-rounded", "send_radians"), ("sent-rounded", "send_coord")}
    assert failures == []
