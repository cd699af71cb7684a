"""Count the messages, noise and gaps of recordings."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from capture.export.exporting import START, polled, recording, reply
from capture.lines import written
from cobotwire.capture import Packet
from cobotwire.capture.gaps import Gaps
from cobotwire.capture.overview import overview
from cobotwire.inspect.captured import recorded_codecs

SECOND = 10**9


@given(st.lists(st.lists(st.integers(0, 30), max_size=6), max_size=4), st.integers(0, 9))
def test_gaps_are_pauses_longer_than_the_limit(steps: list[list[int]], longest: int) -> None:
    gaps, batches, time = Gaps(longest), [], 0
    for batch in steps:
        batches.append([time := time + step for step in batch])
    times = [time for batch in batches for time in batch]
    expected = [(a, b) for a, b in pairwise(times) if b - a > longest]
    assert [gap for batch in batches for gap in gaps.take(reversed(batch))] == expected


def test_overview_counts_messages_noise_and_gaps_of_each_interface(tmp_path: Path) -> None:
    made = [
        *polled(3),
        Packet(START + SECOND // 10, "received", b"Guru", "noise", "no-header"),
        Packet(START + 3 * SECOND, "received", reply("is_power_on", 1)),
        Packet(START + 4 * SECOND, "sent", polled(1)[0].data, interface=1),
    ]
    path = recording(tmp_path / "arm.pcapng", made, "mycobot280", "mycobot280", finish=False)
    for piece in (100, 1 << 22):
        found = overview(path, recorded_codecs(), SECOND, piece=piece)
        rates = {key: (times.number, times.rate) for key, times in found.messages.items()}
        assert rates == {
            (0, "get_angles.request"): (3, 50.0),
            (0, "get_angles.reply"): (3, 50.0),
            (0, "is_power_on.reply"): (1, None),
            (1, "get_angles.request"): (1, None),
        }
        assert found.times is not None
        assert found.times == (9, START, START + 4 * SECOND)
        assert [gap[:2] for gap in found.gaps] == [(29 * SECOND // 10, START + SECOND // 10)]
        assert {"no-header": 4} in [stream.noise for stream in found.streams]
        assert found.missing.startswith("unfinished")
        assert found.sections == 1


def test_sections_are_counted_also_if_a_packet_looks_like_one(tmp_path: Path) -> None:
    one = written([Packet(1, "sent", written([]))])
    for content, sections in ((one, 1), (one + one, 2)):
        (tmp_path / "arm.pcapng").write_bytes(content)
        found = overview(tmp_path / "arm.pcapng", recorded_codecs(), piece=7)
        assert (found.sections, found.missing) == (sections, "")


def test_overview_reports_damage(tmp_path: Path) -> None:
    whole = written(polled(3))
    path = tmp_path / "arm.pcapng"
    for content, error, missing in (
        (whole[:-3], "", "truncated"),
        (whole[:-40] + bytes(40), "damaged", ""),
        (b"", "not a pcapng recording", ""),
        # Other programs need not mark the end.
        (written([], finish=False).replace(b"cobotwire", b"otherwire"), "", ""),
    ):
        path.write_bytes(content)
        found = overview(path, recorded_codecs())
        assert error in str(found.error or "")
        assert found.missing.partition(":")[0] == missing
