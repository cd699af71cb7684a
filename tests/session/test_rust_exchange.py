"""The exchange of the Rust core decides as the one of Python, which is its specification."""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.loading import table_of
from cobotwire_codegen.publish import edition_json
from probe import Probe, needed
from random_editions import editions
from session.exploring.topics import TOPICS
from session.talks import Talk
from session.twin_search import TwinSearch, edition
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
# How many events in a row `make test` explores on both; `make explore RUST=1` goes on from there.
DEPTHS = {"unread": 3, "echoes": 3}
TALKS = st.lists(
    st.tuples(st.sampled_from(STEPS), st.integers(0, 1 << 32)), min_size=20, max_size=50
)


@lru_cache
def _codec(path: str) -> Codec:
    with open(path) as file:
        return codecs.load(table_of(json.load(file)), "native")


def _talk(probe: Probe, codec: Codec, path: str, seed: int, steps: list[tuple[str, int]]) -> None:
    with Recorder(codec, path) as recorder:
        talk = Talk(codec, seed)
        for name, own in steps:
            talk.step(name, own)
        talk.finish()
    recorder.check(probe.ask)


@needed
@settings(max_examples=60)
@given(st.sampled_from(EDITIONS).map(str), st.integers(0, 1 << 32), TALKS)
def test_both_do_the_same_in_every_edition(
    probe: Probe, path: str, seed: int, steps: list[tuple[str, int]]
) -> None:
    _talk(probe, _codec(path), path, seed, steps)


@needed
@settings(max_examples=12)
@given(st.data(), st.integers(0, 1 << 32), TALKS)
def test_both_do_the_same_with_random_tables(
    probe: Probe,
    tmp_path_factory: pytest.TempPathFactory,
    data: st.DataObject,
    seed: int,
    steps: list[tuple[str, int]],
) -> None:
    folder = tmp_path_factory.mktemp("random")
    document = json.loads(edition_json(data.draw(editions(folder, "rnd"))))
    dice = Random(seed)
    for address in document["frame"].get("addresses", ()):
        address["replies"] = dice.choice(["own", "any", "one", "none"])
    for command in document["commands"]:
        if command["safety"] == "setting":
            command["safety"] = dice.choice(["setting", "motion"])
    path = folder / "edition.json"
    path.write_text(json.dumps(document))
    _talk(probe, codecs.load(table_of(document), "native"), str(path), seed, steps)


@needed
@pytest.mark.parametrize("topic", sorted(TOPICS.keys() - {"everything"}))
def test_both_have_the_same_states_in_every_order_of_events(
    probe: Probe, tmp_path: Path, topic: str
) -> None:
    search = TwinSearch(TOPICS[topic], edition(tmp_path), probe.ask)
    while search.depth < DEPTHS.get(topic, 2):
        search.deepen()
    print(f"\n{topic}: {search}")
    assert not search.found, search.found
