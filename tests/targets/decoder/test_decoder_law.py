"""The decoder page, run in a real browser, decodes every type in every frame as our codec does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import vectors
from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.decoder import edition_script
from random_editions import editions
from strategies import TABLES
from targets.decoder.browser import needs_chromium
from targets.decoder.comparison import compare_all
from targets.expected import Document
from targets.specs import SPECS, edition_of
from targets.vectors.comparison import read
from wrong_models import WRONG, with_wrong_angles

pytestmark = needs_chromium
# Shrinking is of no use, since the browser reads the documents of all examples at once: it starts
# slowly.
COLLECT = settings(phases=[Phase.generate], suppress_health_check=list(HealthCheck))


def test_decoder_page_agrees_with_every_vector() -> None:
    names = sorted(TABLES)
    scripts = [edition_script(vectors.edition(name)) for name in names]
    for found in compare_all(list(zip(map(read, names), scripts))):
        assert found.differences == []
        assert found.vectors > 1000


def test_decoder_page_of_a_wrong_model_differs_from_the_vectors() -> None:
    model, document = vectors.edition("mycobot"), read("mycobot")
    wrong = [replace(with_wrong_angles(model, WRONG[kind]), name=kind) for kind in WRONG]
    documents = [(document | {"edition": each.name}, edition_script(each)) for each in wrong]
    for found in compare_all(documents):
        assert found.differences
        assert all("get_angles" in difference for difference in found.differences)


def test_any_messages_and_streams_are_decoded_as_in_codec(tmp_path: Path) -> None:
    found = [edition_of(name) for name in SPECS]
    found += [vectors.edition(name) for name in sorted(TABLES)]
    documents = [Document(edition) for edition in found]
    documents[SPECS.index("sensor")].add_odd_texts()
    known = list(documents)

    @settings(COLLECT, max_examples=160)
    @given(data=st.data())
    def collect(data: st.DataObject) -> None:
        known[data.draw(st.integers(0, len(known) - 1))].draw(data)

    @settings(COLLECT, max_examples=8)
    @given(data=st.data())
    def collect_of_random_protocols(data: st.DataObject) -> None:
        edition: Edition = data.draw(editions(tmp_path, f"rnd{len(found)}"))
        documents.append(Document(edition))
        for _ in range(5):
            documents[-1].draw(data)
        found.append(edition)

    collect()
    collect_of_random_protocols()
    scripts = [edition_script(edition) for edition in found]
    records = [document.record for document in documents]
    compared = compare_all(list(zip(records, scripts, strict=True)))
    assert [text for each in compared for text in each.differences] == []
    assert sum(each.fields for each in compared) > 100
    noise = {e.get("noise") for r in records for s in r["streams"] for e in s["events"]}
    assert noise >= {"no-header", "bad-length", "unknown-id", "bad-check", "truncated", None}
