"""On each platform, a wait ends if its descriptor is ready, its time is over, or on ``wake``."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator

import pytest

from cobotwire.transport import waiting as waiters
from cobotwire.transport.waiting import Waiter

PLATFORMS = ["linux", "macos"]


@pytest.fixture(params=PLATFORMS)
def waiter(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[Waiter]:
    if request.param == "macos":
        monkeypatch.delattr(os, "eventfd", raising=False)
        monkeypatch.setattr(waiters, "POLLS_TERMINALS", False)
    elif not hasattr(os, "eventfd"):
        pytest.skip("this system has no eventfd")
    made = Waiter()
    yield made
    made.close()


@pytest.fixture
def pipe() -> Iterator[tuple[int, int]]:
    reading, writing = os.pipe()
    yield reading, writing
    for descriptor in (reading, writing):
        os.close(descriptor)


def test_wait_ends_when_the_descriptor_is_ready(waiter: Waiter, pipe: tuple[int, int]) -> None:
    reading, writing = pipe
    assert not waiter.wait(reading, 0)
    assert not waiter.wait(reading, 0.01)
    assert waiter.wait(writing, 60.0, writing=True)
    os.write(writing, b"x")
    assert waiter.wait(reading, 0)
    assert waiter.wait(reading, 60.0)


def test_wake_ends_the_wait_of_another_thread(waiter: Waiter, pipe: tuple[int, int]) -> None:
    waiting = threading.Thread(target=waiter.wait, args=(pipe[0], 60.0))
    waiting.start()
    time.sleep(0.05)
    assert waiting.is_alive()
    waiter.wake()
    waiting.join(10.0)
    assert not waiting.is_alive()


def test_wait_after_wake_or_close_ends_at_once(waiter: Waiter, pipe: tuple[int, int]) -> None:
    waiter.wake()
    started = time.monotonic()
    waiter.wait(pipe[0], 60.0)
    waiter.close()
    waiter.wake()
    waiter.wait(pipe[0], 60.0)
    assert time.monotonic() - started < 30.0
