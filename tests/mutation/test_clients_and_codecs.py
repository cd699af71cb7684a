"""The testers kill a sample of the broken clients and codecs; `make conform` runs all of them."""

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


def test_suite_has_many_mutants_with_unique_ids(suite: Suite) -> None:
    ids = [case.id for case in suite.cases()]
    assert len(ids) == len(set(ids)) > 1000


def test_each_sampled_mutant_is_killed_or_excused(suite: Suite) -> None:
    outcomes = [suite.judge(case) for case in sampled(suite.cases(), 3, seed=7)]
    assert [o.case.id for o in outcomes if not (o.killed_by or o.reason)] == []


def test_correct_subjects_pass(suite: Suite) -> None:
    names = suite.right_runs()
    runs = [suite.accept(name) for name in names[:: len(names) // 2]]
    assert [run for run in runs if not run.passed] == []
