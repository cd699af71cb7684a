"""A short campaign against the client in Node: nothing forbidden happens in any profile.

`make attack CLIENT=node` runs all profiles for minutes.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import pytest

import npm_package
from attack.plans import plan
from attack.profiles import NODE_PROFILES
from attack.running import attack
from targets.typescript.comparison import package

pytestmark = [
    pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing()),
    pytest.mark.skipif(sys.platform != "linux", reason="only there Node and Python share a clock"),
]


@pytest.mark.parametrize("name", ["doubled", "stall", "unplug", "cancellations"])
def test_nothing_forbidden_happens(name: str) -> None:
    package()
    tally = attack(replace(plan(NODE_PROFILES[name], 1, 0.3, 200), users=3, grace=0.3))
    assert tally.counts["calls"] > 0
    assert tally.forbidden == 0, "\n\n".join(tally.failures)
