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
from cobotwire_codegen.publish import edition_json
from probe import Probe, needed
from random_editions import editions
from session.talks import Talk
from session.twins import Recorder
from vectors import ROOT

EDITIONS = sorted((ROOT / "python/cobotwire/editions").glob("*/edition.json"))
STEPS = (
    *["call"] * 4,
    *["turn"] * 5,
    *["arrive"] * 4,
    *["wake"] * 5,
    *("give_up", "lose", "reopen"),
)
TALKS = st.lists(st.tuples(st.sampled_from(STEPS), st.integers(0, 1 << 32)), max_size=50)


@pytest.fixture(scope="module")
def probe() -> Iterator[Probe]:
    made = Probe("exchange")
    yield made
    made.close()


@lru_cache
def _codec(path: str) -> Codec:
    with open(path) as file:
        return codecs.load(table_of(json.load(file)), "native")


def _talk(probe: Probe, codec: Codec, path: str, seed: int, steps: list[tuple[str, int]]) -> None:
    with Recorder(codec, path) as recorder:
        talk = Talk(codec, seed)
        for name, own in steps:
            talk.step(name, own)
    recorder.check(probe.ask)


@needed
@given(st.sampled_from(EDITIONS).map(str), st.integers(0, 1 << 32), TALKS)
def test_both_do_the_same_in_every_edition(
    probe: Probe, path: str, seed: int, steps: list[tuple[str, int]]
) -> None:
    _talk(probe, _codec(path), path, seed, steps)


@needed
@settings(max_examples=25)
@given(st.data(), st.integers(0, 1 << 32), TALKS)
def test_both_do_the_same_with_random_tables(
    probe: Probe,
    tmp_path_factory: pytest.TempPathFactory,
    data: st.DataObject,
    seed: int,
    steps: list[tuple[str, int]],
) -> None:
    folder = tmp_path_factory.mktemp("random")
    document = edition_json(data.draw(editions(folder, "rnd")))
    path = str(folder / "edition.json")
    (folder / "edition.json").write_text(document)
    codec = codecs.load(table_of(json.loads(document)), "native")
    _talk(probe, codec, path, seed, steps)
