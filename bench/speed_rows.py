"""The work that the speed benches time, by name.

A row creates its data only when it is measured, so that the memory is freed before the next row.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, partial
from pathlib import Path

import speed_peers as peers
from cobotwire.codec.interface import Codec, Columns, Frame, Noise, Scan
from cobotwire.editions.mycobot280 import TABLE
from damage import noisy
from speed_table import Timed
from streams import stream_a

ANGLES = [1.5, -20.25, 30.0, 0.01, 0.29, -179.99]
CHUNK = 4096
# The calls in a round, for rows with one frame.
MANY = 20_000
# The number of frames that a large stream repeats: too many for caches and branch predictors.
REPEATED = 1_000_000


class Streams:
    """The input of all rows, as files in a folder, so that several processes read the same."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    @classmethod
    def write(cls, folder: Path, megabytes: float, frames: int) -> Streams:
        """Write large streams of that size, and a small one with that number of frames."""
        line = stream_a(TABLE, min(REPEATED, max(frames, round(megabytes * 70_000))))
        bad = noisy(TABLE, line)
        for name, data in (("clean", line.data), ("noisy", bad.data)):
            times = max(1, round(megabytes * 1e6 / len(data)))
            (folder / name).write_bytes(data * times)
        (folder / "few").write_bytes(stream_a(TABLE, frames).data)
        return cls(folder)

    @cached_property
    def clean(self) -> bytes:
        """The large stream."""
        return (self._folder / "clean").read_bytes()

    @cached_property
    def noisy(self) -> bytes:
        """The large stream with 10 % noise."""
        return (self._folder / "noisy").read_bytes()

    @cached_property
    def few(self) -> bytes:
        """The small stream, which becomes Python objects."""
        return (self._folder / "few").read_bytes()


class Reused:
    """Pass the previous result as ``out=``, like a program that reads many captures."""

    def __init__(self, call: Callable[..., Scan | Columns]) -> None:
        self.call = call
        self.last: Scan | Columns | None = None

    def __call__(self) -> object:
        """Call once more."""
        self.last = self.call(out=self.last)
        return self.last


def frames_of(codec: Codec, data: bytes) -> Iterator[Frame]:
    """Yield all frames of a buffer block by block, so that memory stays small."""
    framer = codec.framer("reply")
    for start in range(0, len(data), 1 << 16):
        for event in framer.feed(data[start : start + (1 << 16)]):
            if not isinstance(event, Noise):
                yield event


def _iterated(codec: Codec, data: bytes) -> None:
    for frame in frames_of(codec, data):
        frame.values  # noqa: B018  (reading it is the work)


def _in_chunks(codec: Codec, data: bytes) -> None:
    framer = codec.framer("reply")
    for start in range(0, len(data), CHUNK):
        framer.feed(data[start : start + CHUNK])


def _eager(codec: Codec, data: bytes) -> list[tuple[object, ...]]:
    return [
        event.values for event in codec.framer("reply").feed(data) if not isinstance(event, Noise)
    ]


def _feed(codec: Codec, _: Streams) -> Timed:
    framer, frame = codec.framer("reply"), codec.encode("get_angles", "reply", (ANGLES,))
    return Timed(lambda: framer.feed(frame)[0].values, MANY)  # type: ignore[union-attr]


def _encode(codec: Codec, _: Streams) -> Timed:
    values = (ANGLES, 30)
    return Timed(lambda: codec.encode("send_angles", "request", values), MANY)


class _Captures:
    """Two captures, read in turn or in two threads; each reuses its own memory."""

    def __init__(self, codec: Codec, data: bytes) -> None:
        self.codec, self.data = codec, data
        self.out: list[Columns | None] = [None, None]

    def read(self, place: int) -> None:
        out = self.out[place]
        self.out[place] = self.codec.decode_columns(self.data, "reply", out=out)

    def both(self) -> list[Callable[[], object]]:
        return [partial(self.read, place) for place in (0, 1)]


def in_turn(works: Sequence[Callable[[], object]]) -> None:
    """Do one work after the other."""
    for work in works:
        work()


def together(works: Sequence[Callable[[], object]]) -> None:
    """Do each work in a thread of its own."""
    threads = [threading.Thread(target=work) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


Row = Callable[[Codec, Streams], Timed]

BULK: dict[str, Row] = {
    "memcpy": lambda _, streams: Timed(peers.memcpy(streams.clean)),
    "memcpy of the noisy stream": lambda _, streams: Timed(peers.memcpy(streams.noisy)),
    "scan": lambda codec, streams: _reused(codec.scan, streams.clean),
    "noisy scan": lambda codec, streams: _reused(codec.scan, streams.noisy),
    "fresh": lambda codec, streams: Timed(partial(codec.decode_columns, streams.clean, "reply")),
    "reused": lambda codec, streams: _reused(codec.decode_columns, streams.clean),
    "raw": lambda codec, streams: _reused(codec.decode_columns, streams.clean, raw=True),
    "noisy raw": lambda codec, streams: _reused(codec.decode_columns, streams.noisy, raw=True),
    "memcpy, two threads": lambda _, streams: Timed(_memcpy_in_two(streams.clean)),
    "scan, two threads": lambda codec, streams: _reused(codec.scan, streams.clean, workers=2),
    "noisy scan, two threads": lambda codec, streams: _reused(codec.scan, streams.noisy, workers=2),
    "fresh, two threads": lambda codec, streams: Timed(
        partial(codec.decode_columns, streams.clean, "reply", workers=2)
    ),
    "reused, two threads": lambda codec, streams: _reused(
        codec.decode_columns, streams.clean, workers=2
    ),
    "raw, two threads": lambda codec, streams: _reused(
        codec.decode_columns, streams.clean, raw=True, workers=2
    ),
    "noisy raw, two threads": lambda codec, streams: _reused(
        codec.decode_columns, streams.noisy, raw=True, workers=2
    ),
}
OBJECTS: dict[str, Row] = {
    "list": lambda codec, streams: _objects(_lazy, codec, streams),
    "iterated": lambda codec, streams: _objects(_iterated, codec, streams),
    "chunks": lambda codec, streams: _objects(_in_chunks, codec, streams),
    "eager": lambda codec, streams: _objects(_eager, codec, streams),
}
SINGLE: dict[str, Row] = {
    "a no-op call": lambda *_: Timed(lambda: None, MANY),
    "feed": _feed,
    "encode": _encode,
}
THREADS: dict[str, Row] = {
    "one thread": lambda codec, streams: _threads(in_turn, codec, streams),
    "two": lambda codec, streams: _threads(together, codec, streams),
}


def _threads(run: Callable[..., None], codec: Codec, streams: Streams) -> Timed:
    return Timed(partial(run, _Captures(codec, streams.clean).both()))


def _lazy(codec: Codec, data: bytes) -> object:
    return codec.framer("reply").feed(data)


def _memcpy_in_two(data: bytes) -> Callable[[], object]:
    """Return a function that copies the halves of the input at the same time."""
    half = len(data) // 2
    return partial(together, [peers.memcpy(data[:half]), peers.memcpy(data[half:])])


def _reused(call: Callable[..., Scan | Columns], data: bytes, **options: int) -> Timed:
    return Timed(Reused(partial(call, data, "reply", **options)))


def _objects(work: Callable[[Codec, bytes], object], codec: Codec, streams: Streams) -> Timed:
    return Timed(partial(work, codec, streams.few))
