"""The decoder page, run in a real browser, agrees with the Python codecs on every vector."""

from __future__ import annotations

import random

import pytest

import vectors
from cobotwire.codec.interface import Codec
from cobotwire_codegen.targets.decoder import edition_script
from strategies import TABLES, codec_of
from targets.comparison import ToolMissing
from targets.decoder import browser
from targets.decoder.comparison import compare, judged
from targets.vectors.comparison import Record, joined, read
from wrong_models import WRONG, with_wrong_angles

EDITIONS = sorted(TABLES)
STREAMS = 400

try:
    browser.chromium()
    MISSING = ""
except ToolMissing as error:
    MISSING = str(error)
pytestmark = pytest.mark.skipif(bool(MISSING), reason=MISSING)


@pytest.mark.parametrize("edition", EDITIONS)
def test_decoder_page_agrees_with_every_vector(edition: str) -> None:
    found = compare(edition)
    assert found.differences == []
    assert found.vectors > 1000


@pytest.mark.parametrize("edition", EDITIONS)
def test_streams_of_both_directions_are_framed_as_in_codec(edition: str) -> None:
    chance = random.Random(6)
    document = read(edition)
    frames = [bytes.fromhex(record["bytes"]) for record in document["messages"]]
    codec = codec_of(edition, "native")
    streams = [_damaged(chance, frames) for _ in range(STREAMS)]
    records = [_record(codec, data) for data in streams]
    found = {"edition": edition, "messages": [], "malformed": [], "streams": records}
    script = edition_script(vectors.edition(edition))
    assert judged(found, script).differences == []
    noise = {event.get("noise") for record in records for event in record["events"]}
    assert noise >= {"no-header", "bad-length", "unknown-id", "bad-check", "truncated", None}


def _damaged(chance: random.Random, frames: list[bytes]) -> bytes:
    """Return frames of both directions, some with a byte changed, lost or inserted."""
    data = bytearray(b"".join(chance.choices(frames, k=4)))
    for _ in range(chance.randrange(4)):
        at = chance.randrange(len(data))
        byte = chance.choice((0xFE, 0xFA, chance.randrange(256)))
        data[at : at + chance.randrange(2)] = bytes([byte] * chance.randrange(3))
    return bytes(data)


def _record(codec: Codec, data: bytes) -> Record:
    framer = codec.framer("both")
    events = joined([*framer.feed(data), *framer.flush()])
    return {"name": data.hex(), "direction": "both", "bytes": data.hex(" "), "events": events}


@pytest.mark.parametrize("kind", WRONG)
def test_decoder_page_of_a_wrong_model_differs_from_the_vectors(kind: str) -> None:
    wrong = with_wrong_angles(vectors.edition("mycobot"), WRONG[kind])
    script = edition_script(wrong)
    found = judged(read("mycobot"), script).differences
    assert found
    assert all("get_angles" in difference for difference in found)
