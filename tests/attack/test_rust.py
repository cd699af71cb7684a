"""A short campaign against the Rust clients: nothing forbidden happens in any profile.

`make attack CLIENT=rust` runs all profiles for minutes.
"""

from __future__ import annotations

import sys
from concurrent.futures import Future
from dataclasses import replace
from typing import Any

import pytest

import probe
from attack.plans import plan
from attack.profiles import RUST_PROFILES
from attack.running import attack
from probe_client import ProbeClient

pytestmark = [
    probe.needed,
    pytest.mark.skipif(sys.platform != "linux", reason="only there Rust and Python share a clock"),
]
# The most different ones; each costs processor time.
RUNS = [("doubled", "rust"), ("harsh", "rust async"), ("stall", "rust"), ("unplug", "rust async")]


@pytest.mark.parametrize(("name", "client"), RUNS)
def test_nothing_forbidden_happens(name: str, client: Any) -> None:
    profile = RUST_PROFILES[name]
    tally = attack(replace(plan(profile, 1, 0.3, 200), client=client, users=3, grace=0.3))
    assert tally.counts["calls"] > 0
    assert tally.forbidden == 0, "\n\n".join(tally.failures)


def test_result_of_another_call_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
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
