"""A short campaign: nothing forbidden happens in any profile.

`make attack` runs it for minutes; CLIENT=rust and CLIENT=node choose those clients. A failure shows
the seed and the calls around it.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from typing import Any

import pytest

import npm_package
import probe
from attack.plans import plan
from attack.profiles import NODE_PROFILES, PROFILES, RUST_PROFILES
from attack.running import attack
from attack.tally import Tally, markdown, text
from probe_client import ProbeClient
from targets.typescript.comparison import package

SECONDS = 0.5
PROCESSES = 4
RUNS = [(name, client) for name, profile in PROFILES.items() for client in profile.clients]
one_clock = pytest.mark.skipif(
    sys.platform != "linux", reason="only on Linux, other languages share a clock with Python"
)
needs_node = pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())
# The most different profiles; each costs processor time.
RUST = [("doubled", "rust"), ("harsh", "rust async"), ("stall", "rust"), ("unplug", "rust async")]
NODE = [(name, "node") for name in ("doubled", "stall", "unplug", "cancellations")]


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
    _assert_good(tallies[name, client].result())


def _assert_good(tally: Tally) -> None:
    assert tally.counts["calls"] > 0
    assert tally.forbidden == 0, "\n\n".join(tally.failures)


@one_clock
@pytest.mark.parametrize(
    ("name", "client"),
    [
        *(pytest.param(*run, marks=probe.needed) for run in RUST),
        *(pytest.param(*run, marks=needs_node) for run in NODE),
    ],
)
def test_nothing_forbidden_happens_in_another_language(name: str, client: Any) -> None:
    if client == "node":
        package()
    profile = (NODE_PROFILES if client == "node" else RUST_PROFILES)[name]
    _assert_good(attack(replace(plan(profile, 1, 0.3, 200), client=client, users=3, grace=0.3)))


@one_clock
@probe.needed
def test_rust_call_with_the_result_of_another_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    ask, answers = ProbeClient._ask, list[Future[dict[str, Any]]]()

    def asked(client: ProbeClient, line: dict[str, Any], number: int = 0) -> Any:
        answer = ask(client, line, number)
        if line.get("call") == "get_encoder":
            answers.append(answer)
            return answers[max(0, len(answers) - 2)]
        return answer

    monkeypatch.setattr(ProbeClient, "_ask", asked)
    tally = attack(replace(plan(RUST_PROFILES["benign"], 1, 5.0, 80), users=1))
    assert tally.counts["wrong"] > 0


def test_table_has_a_row_for_each_profile_and_their_sum() -> None:
    rows = [Tally("one", Counter(calls=1200, right=1200)), Tally("two", Counter(calls=3, wrong=1))]
    assert text(rows).splitlines()[-1].split()[:3] == ["all", "1,203", "1,200"]
    assert markdown(rows).count("\n") == 5
    assert rows[1].forbidden == 1
