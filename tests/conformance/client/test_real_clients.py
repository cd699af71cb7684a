"""Real clients play whole sessions over a pty and TCP, as in bench/client_findings.py."""

from __future__ import annotations

import pytest

from client_findings import LINES, Line, judged
from cobotwire.conformance import Report


def judged_on_time(client: str, line: Line) -> tuple[Report, list[str]]:
    """Run the session; run it again if the client seemed to wait too short.

    A referee that does not run for a moment receives two requests at once, which the client sent
    one after the other. A client that does not wait is found in each session.
    """
    for _ in range(3):
        report, failures = judged(client, line)
        if "reply-given-time" not in {result.case for result in report.failures}:
            break
    return report, failures


OURS = ["cobotwire", "cobotwire tcp", "cobotwire asyncio", "cobotwire asyncio tcp"]


@pytest.mark.parametrize("client", OURS)
@pytest.mark.parametrize("line", ["good", "no-acks"])
def test_our_client_passes_on_a_good_line(client: str, line: str) -> None:
    report, failures = judged_on_time(client, LINES[line])
    assert report.failures == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.parametrize("line", ["lost", "late", "merged", "noise", "split"])
def test_our_client_passes_on_a_bad_line(line: str) -> None:
    report, failures = judged_on_time("cobotwire", LINES[line])
    assert report.failures == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
def test_pymycobot_on_a_good_line_fails_only_by_rounding() -> None:
    report, failures = judged("pymycobot", LINES["good"])
    found = {(r.case, r.command) for r in report.failures}
    assert found == {("sent-rounded", "send_radians"), ("sent-rounded", "send_coord")}
    assert failures == []
