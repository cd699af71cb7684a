"""The simulated arm of every edition conforms, in stepped time.

``tests/editions`` calls every command of every edition on real lines; ``test_started.py`` and
``test_real_line.py`` test devices on them.
"""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import editions
from cobotwire.cli.shared.subject_connection import Lacking
from cobotwire.conformance import Verdict
from cobotwire.conformance.device import Tester
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from conformance.device.testing import on_peer, results_of
from vectors import sampled


def _tester(edition: str, *, stated: bool = True, **options: Any) -> Tester:
    """Return a tester with all permissions; ``stated``: the arm notes which queries it lacks."""
    table = editions.load(edition).TABLE
    clock, lacking = SteppedClock(), Lacking(table)
    arm = SimulatedArm(table, clock=clock, on_note=lacking.note if stated else None)
    return on_peer(arm, clock, table, lacking=lacking.reasons, **options)


@pytest.mark.parametrize("edition", sampled())
def test_simulated_arm_of_an_edition_conforms(edition: str) -> None:
    tester = _tester(edition)
    report = tester.run()
    assert [(r.case, r.command, r.reason) for r in report.failures] == []
    assert report.conforms
    passed = sum(result.verdict is Verdict.PASS for result in report.results)
    inconclusive = sum(result.verdict is Verdict.INCONCLUSIVE for result in report.results)
    # Without a geometry, queries of coordinates are silent; the myBuddy has the most of them.
    assert passed > (7 if edition == "mybuddy" else 8) * inconclusive
    assert passed > 3 * len(tester.table.commands)
    assert edition not in COMPLETE or passed == len(report.results)


# The edition of the document and its delta have everything that the test cases need.
COMPLETE = ("mycobot", "mycobot280")


@pytest.mark.parametrize("edition", ["mypalletizer260", "pro450"])
def test_silence_of_a_query_fails_once_and_option_excuses_it(edition: str) -> None:
    failures = _tester(edition, stated=False).run().failures
    silent = frozenset(result.command for result in failures)
    assert "get_coords" in silent
    assert {result.case for result in failures} == {"query-replied"}
    assert len(failures) == len(silent)
    excused = results_of(_tester(edition, stated=False, optional=silent), *silent)
    assert Verdict.FAIL not in {result.verdict for result in excused}


# The test above takes the first address, LEFT.
@pytest.mark.parametrize("address", ["RIGHT", "WAIST"])
def test_single_limb_of_a_robot_with_three_conforms(address: str) -> None:
    report = _tester("mybuddy", address=address).run()
    assert [(r.case, r.command, r.reason) for r in report.failures] == []
