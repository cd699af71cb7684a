"""A short campaign against the Rust clients: nothing forbidden happens in any profile.

`make attack CLIENT=rust` runs it for minutes.
"""

from __future__ import annotations

import sys
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
SECONDS = 0.3


@pytest.mark.parametrize("name", RUST_PROFILES)
def test_nothing_forbidden_happens(name: str) -> None:
    profile, seed = RUST_PROFILES[name], list(RUST_PROFILES).index(name)
    client = profile.clients[seed % len(profile.clients)]
    chosen = replace(plan(profile, seed, SECONDS, 200), client=client, users=3, grace=0.3)
    tally = attack(chosen)
    assert tally.counts["calls"] > 0
    assert tally.forbidden == 0, "\n\n".join(tally.failures)


def test_results_that_are_exchanged_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The machinery sees what the Rust client got, not what it ought to get."""
    began, kept = ProbeClient._ask, []

    def swapped(client: ProbeClient, line: dict[str, Any], number: int = 0) -> Any:
        answer = began(client, line, number)
        if line.get("call") != "get_encoder":
            return answer
        kept.append(answer)
        return kept[-2] if len(kept) > 1 else answer

    monkeypatch.setattr(ProbeClient, "_ask", swapped)
    chosen = plan(RUST_PROFILES["benign"], 1, SECONDS, 200)
    tally = attack(replace(chosen, users=1))
    assert tally.counts["wrong"] > 0
