"""The exchange of the Rust core makes the same decisions as that of Python, its specification."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
from typing import Any

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from cobotwire import codec as codecs
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
# How many events in a row `make test` explores on both; `make explore RUST=1` explores more.
DEPTHS = {"unread": 3, "echoes": 3}


def _talk(probe: Probe, document: Any, path: Path, dice: Random, times: int) -> None:
    """Run random events on the Python and the Rust exchange; compare their decisions."""
    codec = codecs.load(table_of(document), "native")
    with Recorder(str(path)) as recorder:
        for _ in range(times):
            talk = Talk(codec, dice.getrandbits(32))
            for name in dice.choices(STEPS, k=40):
                talk.step(name, dice.getrandbits(32))
            talk.finish()
    recorder.check(probe.ask)


# With fixed seeds, these runs notice every changed rule or text; Hypothesis would make runs that
# differ less from each other.
@needed
@pytest.mark.parametrize("path", EDITIONS, ids=lambda path: path.parent.name)
def test_both_do_the_same_in_every_edition(probe: Probe, path: Path) -> None:
    _talk(probe, json.loads(path.read_text("utf-8")), path, Random(path.parent.name), 20)


@needed
@settings(max_examples=12, phases=[Phase.generate])
@given(st.data(), st.integers(0, 1 << 32))
def test_both_do_the_same_with_random_tables(
    probe: Probe, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject, seed: int
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
    _talk(probe, document, path, dice, 3)


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
