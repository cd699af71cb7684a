"""Read captures into columns; compare them with the messages that the Python reader yields."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from capture.lines import FRAMES, reader, written
from cobotwire.capture import Direction, Packet
from cobotwire.capture.captured_columns import CapturedColumns
from cobotwire.capture.columns import read_batches, read_columns
from cobotwire.capture.streams import cut
from cobotwire.codec.interface import Frame
from cobotwire.inspect.captured import recorded_codecs
from cobotwire.protocol.errors import ProtocolError

codecs = recorded_codecs("mycobot")

Place = tuple[int, str, int, int]


def framed(data: bytes) -> tuple[dict[str, list[Place]], list[Place]]:
    """Return the offsets of frames by command, and of rejected frames, from the Python reader."""
    capture = reader(data)
    found: dict[str, list[Place]] = {}
    rejected: list[Place] = []
    for stream, events, _ in cut(capture, lambda index: codecs(capture.interfaces[index])):
        for event in events:
            if isinstance(event, Frame):
                time_ns = stream.time_of(event.offset)
                place = stream.interface, stream.direction, event.offset, time_ns
                try:
                    name = event.message.command.name
                except ProtocolError:
                    rejected.append(place)
                else:
                    found.setdefault(name, []).append(place)
    return {name: sorted(places) for name, places in found.items()}, sorted(rejected)


def placed(batches: Sequence[CapturedColumns]) -> tuple[dict[str, list[Place]], list[Place]]:
    """Return the offsets of rows by command, and of rejected frames, from columns."""
    found: dict[str, list[Place]] = {}
    rejected: list[Place] = []
    for stream in (stream for batch in batches for stream in batch.streams):
        where: tuple[Any, Any] = stream.interface, stream.direction
        for rows in stream:
            places = [(*where, at, time) for at, time in zip(rows.offset, rows.time)]
            found.setdefault(rows.command.name, []).extend(places)
        rejected += [(*where, at, time) for time, at in zip(*stream.rejected)]
    return {name: sorted(places) for name, places in found.items()}, sorted(rejected)


@st.composite
def traffic(draw: st.DrawFn) -> list[Packet]:
    """Generate packets of frames, parts of frames and noise; times mostly increase."""
    packets, time = [], 10**18
    for _ in range(draw(st.integers(0, 12))):
        data = b"".join(draw(st.lists(st.sampled_from(FRAMES), max_size=3)))
        cut = draw(st.integers(0, len(data)))
        for part in (data[:cut], data[cut:]):
            time += draw(st.sampled_from([0, 1, 10**6, 499_999_999, 10**9, -(10**9)]))
            ways: list[Direction] = ["sent", "received", "received", "unknown"]
            way = draw(st.sampled_from(ways))
            packets.append(Packet(time, way, part, interface=draw(st.integers(0, 1))))
    return packets


@settings(max_examples=50)
@given(traffic(), st.integers(1, 300))
def test_columns_have_the_frames_and_times_of_the_python_reader(
    packets: list[Packet], piece: int
) -> None:
    data = written(packets, "/dev/a", "/dev/b")
    expected = framed(data)
    assert placed([read_columns(data, codecs)]) == expected
    assert placed(list(read_batches(data, codecs, piece=piece))) == expected


def test_frame_has_the_time_of_its_first_byte_if_each_byte_came_by_itself() -> None:
    # A reader that forgets the first byte of an unfinished frame reports the time of a later one.
    start, step = 10**18, 10**6
    line = b"".join(FRAMES)
    data = written(
        Packet(start + at * step, "received", line[at : at + 1]) for at in range(len(line))
    )
    expected = {
        "get_angles": [(0, "received", 5, start + 5 * step)],
        "is_power_on": [(0, "received", 22, start + 22 * step)],
    }
    for piece in (1, 40, len(data)):
        assert placed(list(read_batches(data, codecs, piece=piece))) == (expected, [])
