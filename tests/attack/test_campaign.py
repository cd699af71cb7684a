"""A short campaign: nothing forbidden happens in any profile.

`make attack` runs it for minutes. A failure here shows the seed and the calls around it.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from attack.plans import plan
from attack.profiles import PROFILES
from attack.running import attack
from attack.table import markdown, text
from attack.tally import Tally

SECONDS = 0.7


@pytest.mark.parametrize("name", list(PROFILES))
def test_nothing_forbidden_happens(name: str) -> None:
    profile = PROFILES[name]
    for seed, client in enumerate(profile.clients, 1):
        chosen = replace(plan(profile, seed, SECONDS, 400), client=client, grace=0.3)
        tally = attack(chosen)
        assert tally.calls > 0
        assert tally.forbidden == 0, "\n\n".join(tally.failures)


def test_table_has_a_row_for_each_profile_and_their_sum() -> None:
    tallies = [Tally("one", calls=1200, right=1200), Tally("two", calls=3, wrong=1)]
    assert text(tallies).splitlines()[-1].split()[:3] == ["all", "1,203", "1,200"]
    assert markdown(tallies).count("\n") == 5
    assert tallies[1].forbidden == 1
