"""The device tester finds broken devices of every edition; ``make conform`` runs more of them."""

from __future__ import annotations

from random import Random

import pytest

from cobotwire import editions
from mutation.device.suite import DeviceSuite
from mutation.running import sampled

# The test cases of one command kill these, so a run takes milliseconds.
QUICK = ("header", "LEN", "no reply")


@pytest.mark.parametrize("edition", editions.names())
def test_broken_device_of_each_edition_is_found(edition: str) -> None:
    suite = DeviceSuite(editions.load(edition).TABLE)
    quick = [case for case in suite.cases() if case.kind in QUICK]
    # Each edition gets other commands.
    seed = Random(edition).randrange(1 << 32)
    outcomes = [suite.judge(case) for case in sampled(quick, 1, seed)]
    assert len(outcomes) == len(QUICK)
    for outcome in outcomes:
        assert outcome.killed_by, outcome
