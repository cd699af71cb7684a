"""The decoder page decodes every type in every frame format as our codec does."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from cobotwire.codec.interface import Listening
from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.decoder import edition_script
from random_editions import editions
from raw_messages import raw_messages
from targets.c.specs import SPECS, edition_of
from targets.comparison import ToolMissing
from targets.decoder import browser
from targets.decoder.comparison import judged_all
from targets.expected import Document, frames_with_odd_texts

try:
    browser.chromium()
    MISSING = ""
except ToolMissing as error:
    MISSING = str(error)
pytestmark = pytest.mark.skipif(bool(MISSING), reason=MISSING)
# Shrinking is of no use, since the browser judges the documents of all examples at once: it starts
# slowly.
COLLECT = settings(phases=[Phase.generate], suppress_health_check=list(HealthCheck))
LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])


def test_specs_of_other_makers_are_decoded_as_in_codec() -> None:
    found = [edition_of(path) for path in SPECS.values()]
    documents = [Document(edition) for edition in found]
    [sensor] = [each for each in documents if each.record["edition"] == "sensor"]
    for frame in frames_with_odd_texts(sensor.codec):
        sensor.add("reply", frame)

    @settings(COLLECT, max_examples=80)
    @given(data=st.data())
    def collect(data: st.DataObject) -> None:
        _add(data.draw(st.sampled_from(documents)), data)

    collect()
    _assert_decoded(found, documents)


def test_random_protocols_are_decoded_as_in_codec(tmp_path: Path) -> None:
    found: list[Edition] = []
    documents: list[Document] = []

    @settings(COLLECT, max_examples=8)
    @given(data=st.data())
    def collect(data: st.DataObject) -> None:
        edition = data.draw(editions(tmp_path, f"rnd{len(found)}"))
        document = Document(edition)
        for _ in range(5):
            _add(document, data)
        found.append(edition)
        documents.append(document)

    collect()
    _assert_decoded(found, documents)


def _assert_decoded(found: list[Edition], documents: list[Document]) -> None:
    scripts = [edition_script(edition) for edition in found]
    records = [document.record for document in documents]
    compared = judged_all(list(zip(records, scripts, strict=True)))
    assert [text for each in compared for text in each.differences] == []
    assert sum(each.fields for each in compared) > 50


def _add(document: Document, data: st.DataObject) -> None:
    table = document.codec.table
    message = data.draw(raw_messages(table))
    document.add(message.direction, message.frame)
    frame = bytearray(message.frame)
    for _ in range(data.draw(st.integers(1, 2))):
        frame[data.draw(st.integers(0, len(frame) - 1))] = data.draw(st.integers(0, 255))
    document.add(message.direction, bytes(frame))
    # With a right check, most changes are changes of values.
    body = bytes(frame[: len(frame) - table.frame.check_size])
    document.add(message.direction, body + table.frame.end(body))
    noise = data.draw(st.binary(max_size=4))
    stream = bytes(frame) + noise + message.frame + message.frame[:-1]
    document.stream(data.draw(LISTENING), stream)
