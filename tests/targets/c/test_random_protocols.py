"""C code generated from a random protocol reads, builds and frames its messages."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from random_editions import editions
from targets.c.agreement import Sides, compare_messages, compare_streams
from targets.c.compiled import missing

pytestmark = pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))
NUMBERS = itertools.count()


# Each example compiles a program, so shrinking would take minutes.
@settings(
    max_examples=3, phases=[Phase.reuse, Phase.generate], suppress_health_check=list(HealthCheck)
)
@given(data=st.data())
def test_random_protocol_runs_in_c(tmp_path: Path, data: st.DataObject) -> None:
    sides = Sides(data.draw(editions(tmp_path, f"rnd{next(NUMBERS)}")))
    for _ in range(6):
        compare_messages(sides, data)
        compare_streams(sides, data)
    sides.peer.close()
