"""A line that is full for a while delays no call beyond its deadline, and mixes up no replies."""

from __future__ import annotations

import os
import threading
import time
import tty
from collections.abc import Iterator
from contextlib import suppress

import pytest

from cobotwire import MyCobot, ReplyTimeout, RetryPolicy

TIMEOUT = 0.3
GRACE = 0.5


class FullLine:
    """A pseudo-terminal whose other end stops reading after the first request."""

    def __init__(self) -> None:
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._slave, False)
        self.url = os.ttyname(self._slave)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._fill)

    def __enter__(self) -> FullLine:
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._over.set()
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)

    def _fill(self) -> None:
        os.read(self._master, 100)
        while not self._over.wait(0.002):
            with suppress(BlockingIOError):
                while os.write(self._slave, bytes(64)):
                    pass


@pytest.fixture
def line() -> Iterator[FullLine]:
    with FullLine() as full:
        yield full


def test_query_that_is_repeated_into_a_full_line_ends_in_time(line: FullLine) -> None:
    retry = RetryPolicy(attempts=3, shortest_attempt=0.05)
    with MyCobot(line.url, timeout=TIMEOUT, retry=retry) as arm:
        started = time.monotonic()
        with pytest.raises(ReplyTimeout):
            arm.get_encoder(1)
        assert time.monotonic() - started < TIMEOUT + 0.1
