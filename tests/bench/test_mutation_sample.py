"""A sample of the broken clients and codecs; `make conform` runs all of them."""

from __future__ import annotations

import pytest

from cobotwire.editions.mycobot280 import TABLE
from mutation.client.suite import ClientSuite
from mutation.codec.suite import CodecSuite
from mutation.running import sampled
from mutation.suite import Suite


@pytest.fixture(scope="module", params=["script", "no script", "codec"])
def suite(request: pytest.FixtureRequest) -> Suite:
    if request.param == "codec":
        return CodecSuite(TABLE)
    return ClientSuite(TABLE, with_script=request.param == "script")


def test_there_are_enough_of_them_and_no_two_are_alike(suite: Suite) -> None:
    ids = [case.id for case in suite.cases()]
    assert len(ids) == len(set(ids)) > 1000


def test_each_is_found_or_nobody_could_tell(suite: Suite) -> None:
    outcomes = [suite.judge(case) for case in sampled(suite.cases(), 3, seed=7)]
    assert [o.case.id for o in outcomes if not (o.killed_by or o.reason)] == []


def test_right_ones_are_accepted(suite: Suite) -> None:
    trials = [suite.accept(name) for name in suite.trials()[:: len(suite.trials()) // 2]]
    assert [trial for trial in trials if not trial.passed] == []
