"""An event loop serves many descriptors as correctly as a few."""

from __future__ import annotations

import asyncio
import os
import select
import socket
import sys
from collections.abc import Callable
from contextvars import ContextVar
from functools import partial
from typing import Any

import pytest

from cobotwire.transport.loop_readers import FEW, LoopReaders, readers_of

MANY = FEW + 20
linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has epoll")
needs_readers = pytest.mark.skipif(
    sys.platform == "win32", reason="its loop watches no descriptors"
)
user: ContextVar[int] = ContextVar("user")


class Ends:
    """Pairs of sockets; a loop reads one end of each. ``received`` has the received bytes by
    number."""

    def __init__(self, count: int = MANY) -> None:
        self.readers = LoopReaders(asyncio.get_running_loop())
        self.pairs = [socket.socketpair() for _ in range(count)]
        self.received: list[tuple[int, bytes]] = []
        for number in range(count):
            self.pairs[number][0].setblocking(False)
            self.add(number, partial(self.read, number))

    def add(self, number: int, call: Callable[[], object]) -> None:
        self.readers.add(self.pairs[number][0].fileno(), call)

    def remove(self, number: int) -> None:
        self.readers.remove(self.pairs[number][0].fileno())

    def read(self, number: int) -> None:
        self.received.append((number, self.pairs[number][0].recv(99)))

    def send_all(self) -> None:
        for number, (_, peer) in enumerate(self.pairs):
            peer.send(bytes([number]))

    def close(self) -> None:
        for number, (ours, peer) in enumerate(self.pairs):
            self.remove(number)
            ours.close()
            peer.close()


async def some_turns() -> None:
    for _ in range(5):
        await asyncio.sleep(0)


def watched() -> int:
    loop: Any = asyncio.get_running_loop()
    return len(loop._selector.get_map())


@linux
def test_loop_watches_one_descriptor_for_all_beyond_the_first_few() -> None:
    async def run() -> tuple[int, int]:
        before = watched()
        ends = Ends()
        during = watched()
        ends.close()
        return during - before, watched() - before

    assert asyncio.run(run()) == (FEW + 1, 1)


@needs_readers
def test_each_descriptor_with_received_bytes_is_read_once() -> None:
    async def run() -> list[tuple[int, bytes]]:
        ends = Ends()
        ends.send_all()
        await some_turns()
        ends.close()
        return ends.received

    assert sorted(asyncio.run(run())) == [(number, bytes([number])) for number in range(MANY)]


@needs_readers
def test_error_of_one_call_is_reported_and_the_others_are_served() -> None:
    def fail(ends: Ends) -> None:
        ends.read(MANY - 2)
        raise ValueError("mine")

    async def run() -> tuple[list[int], list[Any]]:
        errors: list[Any] = []
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: errors.append(context["exception"]))
        ends = Ends()
        ends.remove(MANY - 2)
        ends.add(MANY - 2, lambda: fail(ends))
        ends.send_all()
        await some_turns()
        ends.close()
        return sorted(number for number, _ in ends.received), errors

    numbers, errors = asyncio.run(run())
    assert numbers == list(range(MANY))
    assert [str(error) for error in errors] == ["mine"]


@needs_readers
def test_descriptor_that_an_earlier_call_removed_is_not_read() -> None:
    async def run() -> list[int]:
        ends = Ends()
        last = range(FEW, MANY)

        def only(number: int) -> None:
            ends.read(number)
            for other in last:
                if other != number:
                    ends.remove(other)

        for number in last:
            ends.remove(number)
            ends.add(number, partial(only, number))
        ends.send_all()
        await some_turns()
        found = [number for number, _ in ends.received if number in last]
        ends.close()
        return found

    assert len(asyncio.run(run())) == 1


@needs_readers
def test_calls_run_in_the_context_that_added_them() -> None:
    async def run() -> list[tuple[int, int]]:
        ends, seen = Ends(), list[tuple[int, int]]()

        def note(number: int) -> None:
            ends.read(number)
            seen.append((number, user.get()))

        for number in range(MANY):
            ends.remove(number)
            user.set(number)
            ends.add(number, partial(note, number))
        user.set(-1)
        ends.send_all()
        await some_turns()
        ends.close()
        return sorted(seen)

    assert asyncio.run(run()) == [(number, number) for number in range(MANY)]


@linux
def test_loop_watches_all_if_the_process_has_too_many_descriptors_for_an_epoll(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async def run() -> tuple[int, int]:
        def too_many() -> None:
            raise OSError(24, os.strerror(24))

        before = watched()
        monkeypatch.setattr(select, "epoll", too_many)
        ends = Ends()
        during = watched()
        ends.send_all()
        await some_turns()
        ends.close()
        return during - before, len(ends.received)

    assert asyncio.run(run()) == (MANY, MANY)


def test_each_event_loop_has_one_shared_set_of_readers() -> None:
    async def run() -> tuple[LoopReaders, LoopReaders]:
        loop = asyncio.get_running_loop()
        return readers_of(loop), readers_of(loop)

    one, same = asyncio.run(run())
    other, _ = asyncio.run(run())
    assert one is same
    assert other is not one
