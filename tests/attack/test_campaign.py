"""A short campaign: nothing forbidden happens in any profile.

`make attack` runs it for minutes. A failure here shows the seed and the calls around it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context

import pytest

from attack.plans import plan
from attack.profiles import PROFILES
from attack.running import attack
from attack.tally import Tally, markdown, text

SECONDS = 0.5
PROCESSES = 4
RUNS = [(name, client) for name, profile in PROFILES.items() for client in profile.clients]


@pytest.fixture(scope="module")
def tallies() -> Iterator[dict[tuple[str, str], Future[Tally]]]:
    """Start all runs in a pool: each mostly waits, so several processes share a core."""
    plans = {
        (name, client): replace(
            plan(PROFILES[name], seed, SECONDS, 400), client=client, users=3, grace=0.3
        )
        for seed, (name, client) in enumerate(RUNS, 1)
    }
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        yield {run: pool.submit(attack, chosen) for run, chosen in plans.items()}


@pytest.mark.parametrize(("name", "client"), RUNS)
def test_nothing_forbidden_happens(
    tallies: dict[tuple[str, str], Future[Tally]], name: str, client: str
) -> None:
    tally = tallies[name, client].result()
    assert tally.counts["calls"] > 0
    assert tally.forbidden == 0, "\n\n".join(tally.failures)


def test_table_has_a_row_for_each_profile_and_their_sum() -> None:
    rows = [Tally("one", Counter(calls=1200, right=1200)), Tally("two", Counter(calls=3, wrong=1))]
    assert text(rows).splitlines()[-1].split()[:3] == ["all", "1,203", "1,200"]
    assert markdown(rows).count("\n") == 5
    assert rows[1].forbidden == 1
