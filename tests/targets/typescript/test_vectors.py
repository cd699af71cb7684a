"""The codec of the npm package agrees with ours: on all vectors, and on protocols of any kind."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import npm_package
import vectors
from cobotwire import editions
from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from random_editions import editions as random_editions
from targets.expected import Document
from targets.specs import SPECS, edition_of
from targets.typescript.comparison import compare, compare_all
from targets.vectors.comparison import Record, read
from wrong_models import WRONG, with_wrong_angles

pytestmark = pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())
# Shrinking is of no use, since one process reads the documents of all examples.
COLLECT = settings(phases=[Phase.generate], suppress_health_check=list(HealthCheck))


def written(folder: Path, edition: Edition, document: Record) -> tuple[Path, Path]:
    """Write a table and vectors, and return their files."""
    files = folder / f"{edition.name}-table.json", folder / f"{edition.name}.json"
    for path, text in zip(files, (edition_json(edition), json.dumps(document)), strict=True):
        path.write_text(text, encoding="utf-8")
    return files


@pytest.mark.parametrize("edition", editions.names())
def test_every_vector_agrees_with_codec(edition: str) -> None:
    found = compare(edition)
    assert found.differences == []
    assert found.vectors > 1000
    assert found.fields > 300


def test_codec_of_a_wrong_model_differs_from_the_vectors(tmp_path: Path) -> None:
    model, document = vectors.edition("mycobot"), read("mycobot")
    wrong = [replace(with_wrong_angles(model, WRONG[kind]), name=kind) for kind in WRONG]
    for found in compare_all(written(tmp_path, each, document) for each in wrong):
        assert found.differences
        assert all("get_angles" in difference for difference in found.differences)


def test_any_messages_and_streams_are_decoded_and_explained_as_in_codec(tmp_path: Path) -> None:
    found = [edition_of(name) for name in SPECS]
    found += [replace(vectors.edition(name), name=f"all-{name}") for name in editions.names()]
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
        edition: Edition = data.draw(random_editions(tmp_path, f"rnd{len(found)}"))
        documents.append(Document(edition))
        for _ in range(5):
            documents[-1].draw(data)
        found.append(edition)

    collect()
    collect_of_random_protocols()
    records = [document.record for document in documents]
    files = [written(tmp_path, *pair) for pair in zip(found, records, strict=True)]
    compared = compare_all(files)
    assert [text for each in compared for text in each.differences] == []
    assert sum(each.fields for each in compared) > 100
    noise = {e.get("noise") for r in records for s in r["streams"] for e in s["events"]}
    assert noise >= {"no-header", "bad-length", "unknown-id", "bad-check", "truncated", None}
