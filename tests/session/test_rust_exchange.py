"""The exchange of the Rust core decides as the one of Python does, its specification."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import lru_cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.loading import table_of
from probe import Probe, needed
from session.talks import Talk
from session.twins import Recorder
from vectors import ROOT

EDITIONS = sorted((ROOT / "python/cobotwire/editions").glob("*/edition.json"))
STEPS = ("call", "call", "turn", "turn", "arrive", "arrive", "arrive", "wake", "give_up")
RARE = ("lose", "reopen")
TALKS = st.lists(
    st.tuples(st.sampled_from((*STEPS, *STEPS, *RARE)), st.integers(0, 1 << 32)), max_size=50
)


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    made = Probe("exchange")
    yield made
    made.close()


@lru_cache
def _codec(path: str) -> Codec:
    with open(path) as file:
        return codecs.load(table_of(json.load(file)), "native")


@needed
@given(st.sampled_from(EDITIONS).map(str), st.integers(0, 1 << 32), TALKS)
def test_both_do_the_same_in_every_edition(
    probe: Probe, path: str, seed: int, steps: list[tuple[str, int]]
) -> None:
    with Recorder(_codec(path), path) as recorder:
        talk = Talk(_codec(path), seed)
        for name, own in steps:
            talk.step(name, own)
    recorder.check(probe.ask)
