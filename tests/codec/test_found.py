"""Replay the inputs of ``tests/found``, which once revealed faults, on both codecs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, cast

import pytest

from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise, NoiseReason
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Direction
from framed_events import joined
from json_tables import FOUND, codec_of


class Stream(NamedTuple):
    """A line of streams.txt: chunks, each with whether silence follows, and the expected events."""

    table: str
    listening: Listening
    unknown: bool
    chunks: list[tuple[bytes, bool]]
    events: list[Event]

    @property
    def data(self) -> bytes:
        return b"".join(chunk for chunk, _ in self.chunks)


class Single(NamedTuple):
    """A line of frames.txt."""

    table: str
    direction: Direction
    of: str | None
    data: bytes
    outcome: tuple[str, int]


def _lines(name: str) -> Iterator[tuple[list[str], str, str]]:
    for line in (FOUND / name).read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            what, data, outcome = line.split("|")
            yield what.split(), data.strip(), outcome.strip()


def _stream(what: list[str], data: str, outcome: str) -> Stream:
    chunks = [
        (bytes.fromhex(chunk.rstrip("!")), chunk.endswith("!"))
        for part in data.split("/")
        for chunk in part.replace("!", "!/").split("/")
        if chunk.strip()
    ]
    stream = Stream(what[0], cast(Listening, what[1]), "unknown" in what, chunks, [])
    overhead = codec_of(stream.table, "reference").table.frame.overhead
    at = 0
    for word, size in (event.split() for event in outcome.split(",")):
        part = stream.data[at : at + int(size)]
        stream.events.append(
            Frame(at, part, part[overhead])
            if word == "frame"
            else Noise(at, part, cast(NoiseReason, word))
        )
        at += int(size)
    assert at == len(stream.data), "the file accounts for every byte"
    return stream


def _single(what: list[str], data: str, outcome: str) -> Single:
    word, number = outcome.split()
    of = what[2] if len(what) > 2 else None
    return Single(what[0], cast(Direction, what[1]), of, bytes.fromhex(data), (word, int(number)))


STREAMS = [_stream(*line) for line in _lines("streams.txt")]
SINGLES = [_single(*line) for line in _lines("frames.txt")]


def _events(codec: Codec, stream: Stream, chunks: list[tuple[bytes, bool]]) -> list[Event]:
    """Return the events, with adjacent noise of one reason joined."""
    framer = codec.framer(stream.listening, accept_unknown=stream.unknown)
    events: list[Event] = []
    for chunk, silence in [*chunks, (b"", True)]:
        events += framer.feed(chunk) + (framer.flush() if silence else [])
    return joined(events)


@pytest.mark.parametrize(
    "stream", STREAMS, ids=lambda stream: f"{stream.table} {stream.data[:8]!r}"
)
def test_found_stream_has_its_events_in_any_chunks(codec: Codec, stream: Stream) -> None:
    codec = codec_of(stream.table, codec.name)
    assert _events(codec, stream, stream.chunks) == stream.events
    if any(silence for _, silence in stream.chunks):
        return
    data = stream.data
    for size in range(1, len(data) + 1):
        chunks = [(data[at : at + size], False) for at in range(0, len(data), size)]
        assert _events(codec, stream, chunks) == stream.events
    scan = codec.scan(data, stream.listening, accept_unknown=stream.unknown)
    frames = [event.offset for event in stream.events if isinstance(event, Frame)]
    assert list(scan.offset) == frames


@pytest.mark.parametrize("single", SINGLES, ids=lambda single: f"{single.table} {single.data!r}")
def test_found_frame_is_decoded_or_rejected_as_recorded(codec: Codec, single: Single) -> None:
    codec = codec_of(single.table, codec.name)
    assert _outcome(codec, single) == single.outcome


def _outcome(codec: Codec, single: Single) -> tuple[str, int]:
    """Return the command and its variant's index, or the reason of the rejection and its offset."""
    try:
        message = codec.decode(single.direction, single.data, of=single.of)
    except ProtocolError as error:
        return error.reason, error.offset
    variants = message.command.variants(single.direction)
    return message.command.name, [variant is message.variant for variant in variants].index(True)
