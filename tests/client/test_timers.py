"""The timers that the connections of an event loop share."""

from __future__ import annotations

import asyncio
import gc
import time
import weakref
from functools import partial

from cobotwire.client.aio_timers import LoopTimers, Timed, timers_of


def test_calls_are_made_in_the_order_of_their_deadlines() -> None:
    async def run() -> list[str]:
        timers = timers_of(asyncio.get_running_loop())
        calls: list[str] = []
        done = asyncio.Event()
        now = time.monotonic()
        times = {"last": 0.03, "first": 0.01, "second": 0.02, "cancelled": 0.015, "passed": -1.0}
        timed = {name: Timed(partial(calls.append, name)) for name in times}
        for name, seconds in times.items():
            timers.set(timed[name], now + seconds)
        timed["cancelled"].cancel()
        # Only its new time counts.
        timers.set(timed["first"], now + 0.04)
        timers.set(Timed(done.set), now + 0.05)
        await asyncio.wait_for(done.wait(), 10)
        return calls

    assert asyncio.run(run()) == ["passed", "second", "last", "first"]


def test_call_that_raises_does_not_stop_the_others() -> None:
    async def run() -> list[str]:
        loop = asyncio.get_running_loop()
        reported: list[str] = []
        loop.set_exception_handler(lambda _, context: reported.append(str(context["exception"])))
        timers, done = timers_of(loop), asyncio.Event()

        def fail() -> None:
            raise ValueError("failed")

        now = time.monotonic()
        for call in (fail, fail, done.set):
            timers.set(Timed(call), now)
        await asyncio.wait_for(done.wait(), 10)
        return reported

    assert asyncio.run(run()) == ["failed", "failed"]


def test_call_can_set_another_timer() -> None:
    async def run() -> int:
        timers, done = timers_of(asyncio.get_running_loop()), asyncio.Event()
        count = 0

        def call() -> None:
            nonlocal count
            count += 1
            if count < 5:
                timers.set(timed, time.monotonic() + 0.001)
            else:
                done.set()

        timed = Timed(call)
        timers.set(timed, time.monotonic())
        await asyncio.wait_for(done.wait(), 10)
        return count

    assert asyncio.run(run()) == 5


def test_each_loop_has_timers_of_its_own_while_they_are_in_use() -> None:
    def made() -> LoopTimers:
        async def run() -> LoopTimers:
            timers = timers_of(asyncio.get_running_loop())
            assert timers_of(asyncio.get_running_loop()) is timers
            return timers

        return asyncio.run(run())

    one, other = made(), made()
    assert one is not other
    kept = weakref.ref(one)
    del one
    gc.collect()
    assert kept() is None
