"""Asyncio streams that are closed or cancelled during a period, or that share the arm."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from cobotwire import AsyncMyCobot, LinkError, RetryPolicy
from cobotwire.client.aio_streaming import AsyncStream
from cobotwire.editions.mycobot import GetAngles
from scripted_peer import ScriptedPeer

REQUEST = bytes.fromhex("FE FE 02 20 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
OTHERS = bytes.fromhex("FE FE 0E 20 01 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
ASK_POWER = bytes.fromhex("FE FE 02 12 FA")
POWER = bytes.fromhex("FE FE 03 12 01 FA")
NO_GRACE = RetryPolicy(attempts=1, grace=0.0)
# The grace time is far longer than a test takes.
LONG = RetryPolicy(attempts=1, grace=60.0)
# A delay of replies, in seconds, during which a test can act.
SLOW = 0.2
# Seconds after which a test counts as hung.
LONGEST = 15


def run(peer: Any, drive: Callable[[AsyncMyCobot], Awaitable[Any]], **options: Any) -> Any:
    """Return what ``drive`` returns for an arm at the peer, and the bytes that it got."""

    async def main() -> Any:
        async with AsyncMyCobot(peer.url, **options) as arm, asyncio.timeout(LONGEST):
            return await drive(arm)

    with peer:
        result = asyncio.run(main())
    return result, peer.received


async def begun(stream: AsyncStream, peer: Any) -> asyncio.Task[Any]:
    """Return the task that waits for the next sample, after its request has reached the peer."""
    known = len(peer.received)
    task = asyncio.create_task(anext(stream))
    while len(peer.received) == known:
        await asyncio.sleep(0.002)
    return task


def test_call_of_another_task_waits_for_the_reply_that_is_under_way() -> None:
    peer = ScriptedPeer([SLOW, ANGLES], [POWER])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        powered = await arm.is_power_on()
        return (await task).values[0][0], powered

    assert run(peer, drive, timeout=20) == ((1.4, True), REQUEST + ASK_POWER)


def test_late_reply_to_a_cancelled_period_is_not_taken_by_the_next_call() -> None:
    peer = ScriptedPeer([SLOW, ANGLES], [OTHERS])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        return (await arm.get_angles())[0]

    retry = RetryPolicy(attempts=1, grace=2 * SLOW)
    assert run(peer, drive, timeout=20, retry=retry) == (3.96, REQUEST * 2)


def test_silence_after_a_cancelled_period_delays_the_next_call_by_the_grace_time_only() -> None:
    peer = ScriptedPeer([], [ANGLES])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        return (await arm.get_angles())[0]

    retry = RetryPolicy(attempts=1, grace=SLOW)
    assert run(peer, drive, timeout=2 * LONGEST, retry=retry) == (1.4, REQUEST * 2)


def test_outstanding_request_is_noted_for_the_next_session() -> None:
    peer = ScriptedPeer()

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        left = arm._connection._exchange.persist(time.monotonic())
        await arm.close()
        with pytest.raises(LinkError):
            await task
        return [late.request for late in left.late]

    assert run(peer, drive, timeout=20, retry=LONG) == ([REQUEST], REQUEST)


def test_request_that_a_silent_arm_ignores_ends_at_its_deadline() -> None:
    async def drive(arm: AsyncMyCobot) -> Any:
        stream = arm.stream(GetAngles(), rate=20)
        samples = [await anext(stream) for _ in range(3)]
        return [sample.number for sample in samples], stream.report.unanswered

    peer = ScriptedPeer([ANGLES], [], [], [ANGLES], [], [ANGLES])
    result = run(peer, drive, timeout=0.3, retry=NO_GRACE)
    assert result == (([0, 1, 2], 3), REQUEST * 6)


def test_unplugged_port_ends_the_period_that_waits() -> None:
    async def drive(arm: AsyncMyCobot) -> None:
        with pytest.raises(LinkError):
            await anext(arm.stream(GetAngles(), rate=20))

    run(ScriptedPeer([0.02, None]), drive, timeout=20)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_forked_child_neither_reads_nor_writes_the_line_of_a_stream() -> None:
    peer = ScriptedPeer([SLOW, ANGLES])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        child = os.fork()
        if not child:
            steps = arm._connection._steps
            assert steps is not None
            steps.turn()
            os._exit(steps.lost is None)
        _, status = await asyncio.to_thread(os.waitpid, child, 0)
        return status, (await task).values[0][0]

    assert run(peer, drive, timeout=20) == ((0, 1.4), REQUEST)


# At 25 Hz the period begins so soon that only the timer can notice that the stream was closed.
@pytest.mark.parametrize(("rate", "closed_after"), [(2, 0.1), (25, 0.0)])
def test_stream_that_is_closed_before_its_period_sends_nothing(
    rate: float, closed_after: float
) -> None:
    async def drive(arm: AsyncMyCobot) -> int:
        stream, count = arm.stream(GetAngles(), rate=rate), 0
        async for _ in stream:
            count += 1
            asyncio.get_running_loop().call_later(closed_after, stream.close)
        return count

    assert run(ScriptedPeer([ANGLES]), drive) == (1, REQUEST)
