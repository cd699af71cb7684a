"""The benches' streams contain only legal frames, and describe each of them correctly."""

from __future__ import annotations

import numpy as np
import pytest

import damage
import streams
from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame, Listening
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.table import Table

BOTH = pytest.mark.parametrize("table", [TABLE, TABLE_280], ids=lambda table: table.edition)


@BOTH
@pytest.mark.parametrize("listening", ["request", "reply"])
def test_catalogue_holds_every_variant_and_each_frame_decodes(
    table: Table, listening: Listening
) -> None:
    assert listening != "both"
    line = streams.catalogue(table, 3000, listening)
    codec = codecs.load(table, "native")
    variants = {
        (message.command.id, message.variant.size)
        for message in (codec.decode(listening, line.original(i)) for i in range(line.frames))
    }
    assert variants == {(id, variant.size) for id, variant in streams.variants_of(table, listening)}


@BOTH
def test_stream_a_has_its_documented_shares(table: Table) -> None:
    line = streams.stream_a(table, 20_000)
    first = [line.original(index)[:4] for index in range(line.frames)]
    shares = [first.count(bytes([0xFE, 0xFE, 0x0E, id])) / line.frames for id in (0x20, 0x23)]
    assert shares == pytest.approx([0.6, 0.2], abs=0.02)
    assert streams.stream_a(table, 20_000).data == line.data
    assert streams.stream_a(table, 20_000, seed=9).data != line.data


@BOTH
@pytest.mark.parametrize("kind", damage.KINDS)
def test_damaged_stream_describes_each_frame_correctly(table: Table, kind: str) -> None:
    clean = streams.catalogue(table, 3000, "both")
    line = damage.damage(table, clean, kind, 1e-2)
    assert line.data != clean.data
    for index in range(line.frames):
        received = line.data[line.starts[index] : line.ends[index]]
        assert (received == clean.original(index)) == line.whole[index], index
    assert (line.starts[1:] >= line.ends[:-1]).all(), "frames do not overlap"


@pytest.mark.parametrize("kind", damage.BEFORE_FRAMES)
def test_noise_before_frames_damages_no_frame(kind: str) -> None:
    line = damage.damage(TABLE_280, streams.catalogue(TABLE_280, 3000, "both"), kind, 1e-2)
    assert line.whole.all()
    assert len(line.sites) > 0


def test_acks_are_at_their_listed_offsets() -> None:
    for table, legal in [(TABLE, False), (TABLE_280, True)]:
        line = damage.damage(table, streams.stream_a(table, 3000), "ack", 1e-2)
        events = codecs.load(table, "native").framer("reply").feed(line.data)
        found = {event.offset for event in events if isinstance(event, Frame)}
        assert len(line.acks) > 0
        assert found.issuperset(line.acks.tolist()) == legal


@BOTH
@pytest.mark.parametrize("share", [0.02, 0.1])
def test_noisy_stream_holds_the_requested_share_of_noise(table: Table, share: float) -> None:
    clean = streams.stream_a(table, 20_000)
    line = damage.noisy(table, clean, share=share)
    assert 1 - len(clean.data) / len(line.data) == pytest.approx(share, rel=0.05)
    whole = np.flatnonzero(line.whole).tolist()
    assert len(whole) > 0.95 * line.frames
    assert all(line.data[line.starts[i] : line.ends[i]] == clean.original(i) for i in whole)
    assert damage.noisy(table, clean, inside=0).whole.all()
