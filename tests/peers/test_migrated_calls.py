"""A rewritten call does the same as before, or ``cobotwire migrate`` lists it for a decision."""

from __future__ import annotations

import os

import pytest

from cobotwire.pymycobot.migrate.calls import library
from layer_robots import TCP_TWINS
from migrated_calls import compare_migrated

# Every n-th method is compared here; `make layer` compares all of them.
STRIDE = 5
SAMPLED = [name for name in library() if "EVERY_EDITION" in os.environ or name not in TCP_TWINS]


@pytest.mark.parametrize("name", sorted(SAMPLED))
def test_rewritten_call_does_the_same_or_is_listed(name: str) -> None:
    equal, _listed, wrong = compare_migrated(name, STRIDE)
    assert wrong == []
    assert equal
