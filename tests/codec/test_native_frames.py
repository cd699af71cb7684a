"""The native classes of frames and framers: their memory, arguments and attributes.

``test_agreement.py`` compares their values with those of the reference.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from threading import Barrier, Thread
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame, Framer
from cobotwire.editions.mycobot280 import TABLE

CODEC = codecs.load(TABLE, "native")
ANGLES = CODEC.encode("get_angles", "reply", ([1.5, -20.25, 30.0, 0.01, 0.29, -179.99],))
POWER = CODEC.encode("is_power_on", "reply", (1,))


def _frames(count: int, framer: Framer | None = None) -> list[Frame]:
    events = (framer or CODEC.framer("reply")).feed((ANGLES + POWER) * (count // 2))
    return [event for event in events if isinstance(event, Frame)]


@pytest.mark.parametrize("stream", [ANGLES, ANGLES + POWER], ids=["one frame", "two frames"])
def test_frame_takes_at_most_72_bytes_and_is_not_visited_by_the_collector(stream: bytes) -> None:
    for frame in CODEC.framer("reply").feed(stream):
        assert sys.getsizeof(frame) <= 72
        assert not gc.is_tracked(frame)


def test_freed_frames_release_all_that_they_referred_to() -> None:
    """A leak would leave one reference for each frame: to the class, the origin or the values."""
    kind = type(_frames(2)[0])
    framer = CODEC.framer("reply")
    _use(_frames(1000, framer))
    gc.collect()
    before, blocks = sys.getrefcount(kind), sys.getallocatedblocks()
    for _ in range(5):
        _use(_frames(1000, framer))
    gc.collect()
    assert sys.getrefcount(kind) == before
    assert sys.getallocatedblocks() - blocks < 500


def _use(frames: list[Frame]) -> None:
    for place, frame in enumerate(frames):
        for _ in range(place % 4):
            assert frame.values
        if place % 5 == 0:
            assert frame.message.values == frame.values


def test_frames_outlive_their_framer_and_codec() -> None:
    codec = codecs.load(TABLE, "native")
    frame = next(iter(codec.framer("reply").feed(ANGLES)))
    del codec
    gc.collect()
    assert isinstance(frame, Frame)
    assert frame.values == ((1.5, -20.25, 30.0, 0.01, 0.29, -179.99),)
    assert frame.message.command.name == "get_angles"


def test_threads_read_the_same_frames() -> None:
    frames = _frames(4000)
    expected = [CODEC.decode("reply", frame.data).values for frame in frames[:2]] * 2000
    barrier, found = Barrier(4), []

    def read() -> None:
        barrier.wait()
        found.append([(frame.values, frame.values) for frame in frames])

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        threads = [Thread(target=read) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(interval)
    assert len(found) == 4
    for values in found:
        assert values == [(each, each) for each in expected]


@pytest.mark.parametrize(
    "call",
    [
        lambda frame: frame.decode("reply", "reply"),
        lambda frame: frame.decode("reply", direction="reply"),
        lambda frame: frame.decode(by="get_angles"),
        lambda frame: frame.decode("reply", of="get_angles", by=1),
        lambda frame: type(frame)(),
        lambda frame: type("Derived", (type(frame),), {}),
        lambda frame: frame < frame,
    ],
)
def test_wrong_calls_are_type_errors(call: Callable[[Any], Any]) -> None:
    with pytest.raises(TypeError):
        call(_frames(2)[0])


def test_decode_treats_none_as_an_absent_argument() -> None:
    frame = _frames(2)[0]
    assert frame.decode(None, of=None) == frame.decode() == frame.message
    assert frame.decode(direction="reply", of="get_angles") == frame.message


@pytest.mark.parametrize("name", ["offset", "data", "command", "values", "message", "other"])
def test_attributes_cannot_be_set(name: str) -> None:
    frame = _frames(2)[0]
    with pytest.raises(AttributeError):
        setattr(frame, name, 1)


def test_frames_equal_frames_only() -> None:
    one, other = _frames(2), _frames(2)
    assert one == other
    assert hash(one[0]) == hash(other[0])
    assert one[0] != one[1]
    assert one[0] != ANGLES
    assert repr(one[0]) == f"<Frame {ANGLES.hex(' ').upper()} at 0>"


def test_counts_of_a_framer_can_be_read_whenever_it_makes_an_object(codec: Codec) -> None:
    # Making an object may start a collection of garbage, which runs callbacks and other threads.
    framer = codec.framer("reply")
    chunk = (bytes.fromhex("FF FF 01 04 02 38 02 BE") + POWER + b"cmd_len error\r\n") * 20
    seen: list[object] = []

    def read(phase: str, info: dict[str, int]) -> None:
        try:
            seen.append(framer.fed >= framer.pending >= 0 and framer.counters.bytes <= framer.fed)
        except RuntimeError as error:
            seen.append(error)

    threshold = gc.get_threshold()
    gc.callbacks.append(read)
    gc.set_threshold(1, 1000, 1000)
    try:
        for data in (chunk, memoryview(chunk), b"\xfe\xfe"):
            framer.feed(data)
        framer.flush()
    finally:
        gc.set_threshold(*threshold)
        gc.callbacks.remove(read)
    assert len(seen) > 20
    assert set(seen) == {True}
    assert framer.fed == 2 * len(chunk) + 2
