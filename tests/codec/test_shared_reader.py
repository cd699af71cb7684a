"""A column reader serves one thread; a second thread gets an error and changes nothing."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from cobotwire.codec.interface import Codec, ColumnReader, Columns
from cobotwire.protocol.errors import UsageError

ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
USES: dict[str, Callable[[ColumnReader], Any]] = {
    "feed": lambda reader: reader.feed(ANGLES),
    "flush": lambda reader: reader.flush(),
    "pending": lambda reader: reader.pending,
}


class Busy(threading.Thread):
    """Feeds a stream that takes long to read, from a thread of its own."""

    def __init__(self, reader: ColumnReader, stream: bytes) -> None:
        super().__init__()
        self.reader, self.stream = reader, stream
        self.columns: Columns | None = None

    def run(self) -> None:
        self.columns = self.reader.feed(self.stream)


@contextmanager
def busy(codec: Codec) -> Iterator[Busy]:
    """Yield a thread while it reads: the native codec without the interpreter's lock."""
    frames = 1_000_000 if codec.name == "native" else 20_000
    thread = Busy(codec.column_reader("reply"), ANGLES * frames)
    thread.start()
    yield thread
    thread.join()
    assert thread.columns is not None
    assert len(thread.columns.rows("get_angles")) == frames, "the first thread got all its rows"


@pytest.mark.parametrize("name", USES)
def test_second_thread_gets_an_error_while_the_first_one_reads(codec: Codec, name: str) -> None:
    errors: list[UsageError] = []
    with busy(codec) as thread:
        while thread.is_alive() and not errors:
            try:
                # Until the first thread has begun, a call must not change the reader.
                USES["pending"](thread.reader)
                continue
            except UsageError:
                pass
            try:
                USES[name](thread.reader)
            except UsageError as error:
                errors.append(error)
    assert errors, "the two calls never met"
    assert str(errors[0]) == (
        "another thread uses this column reader; give each thread its own, or share a lock"
    )
    assert errors[0].argument == "column_reader"


def test_reader_continues_after_an_error_of_a_second_thread(codec: Codec) -> None:
    with busy(codec) as thread:
        while thread.is_alive():
            try:
                thread.reader.pending  # noqa: B018  (only its error matters)
            except UsageError:
                break
    assert thread.reader.pending == 0
    columns = thread.reader.feed(ANGLES[:5])
    assert (len(columns), thread.reader.pending) == (0, 5)
    [rows] = thread.reader.feed(ANGLES[5:])
    assert rows.offset.tolist() == [len(thread.stream)]
