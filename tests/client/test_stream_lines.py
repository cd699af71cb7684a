"""Requests of asyncio streams are sent without the session while nothing else happens on a line."""

from __future__ import annotations

import asyncio
import os
import time
import tty
from collections.abc import Awaitable
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import AsyncMyCobot, LinkError, RetryPolicy
from cobotwire import codec as codecs
from cobotwire.client.aio_streaming import AsyncStream
from cobotwire.editions.mycobot import TABLE, GetAngles, IsPowerOn
from cobotwire.session import EncodedRequest, Traffic
from driving_streams import ANGLES, LONGEST, OTHERS, REQUEST, run, steps_of
from scripted_peer import PEERS, ScriptedPeer

pytestmark = pytest.mark.skipif(not codecs.native_available(), reason="there is no native module")
ILLEGAL = bytes.fromhex("FE FE 0E 20 7F FF 00 3D FF E6 FF 3F 00 AF FF 51 FA")
ASK_POWER = bytes.fromhex("FE FE 02 12 FA")
POWER = bytes.fromhex("FE FE 03 12 01 FA")
RATE = 25
# Pauses between parts are long enough for a read of its own, or there is no pause.
PAUSE = 0.004
PARTS = st.sampled_from(
    [ANGLES, ANGLES[:7], ANGLES[7:], REQUEST, ILLEGAL, POWER, b"boot\r\n", b"\xfe", PAUSE]
)
SCRIPTS = st.lists(
    st.one_of(st.just([ANGLES]), st.lists(PARTS, max_size=4)), min_size=1, max_size=3
)
NO_GRACE = RetryPolicy(attempts=1, grace=0.0)
# Far longer than a test takes.
LONG = RetryPolicy(attempts=1, grace=60.0)
# A reply that comes so late leaves time to act before it.
SLOW = 0.2


async def begun(stream: AsyncStream, peer: Any) -> asyncio.Task[Any]:
    """Return the task that waits for the next sample, after its request has come to the peer."""
    known = len(peer.received)
    task = asyncio.create_task(anext(stream))
    while len(peer.received) == known:
        await asyncio.sleep(0.002)
    return task


async def sampled(arm: AsyncMyCobot, way: str, slots: int) -> list[object]:
    """Return the results of a stream with that many slots, and how many had no reply."""
    if way == "steps":
        steps_of(arm).native = None
    busy = asyncio.create_task(hold_loop()) if way == "thread" else None
    found: list[object] = []
    async with arm.stream(GetAngles(), rate=RATE) as stream:
        async for sample in stream:
            found.append(sample.values)
            report = stream.report
            if report.samples + report.unanswered >= slots:
                break
    if busy is not None:
        busy.cancel()
    return [*found, stream.report.unanswered]


async def hold_loop() -> None:
    """Let no timer of the loop be punctual, until it is cancelled."""
    while True:
        time.sleep(0.005)
        await asyncio.sleep(0)


@pytest.mark.parametrize("way", ["native", "thread"])
@given(scripts=SCRIPTS)
@settings(max_examples=12, deadline=None)
def test_same_traffic_has_the_same_samples_in_native_calls_and_in_steps(
    way: str, scripts: Any
) -> None:
    slots = len(scripts) + 1
    # A reply ends the stream. The first of these may be too late on a busy machine.
    scripts = [*scripts, *[[ANGLES]] * 20]

    def results(way: str) -> Any:
        def drive(arm: AsyncMyCobot) -> Awaitable[Any]:
            return sampled(arm, way, slots)

        return run(ScriptedPeer(*scripts), drive, timeout=0.05, retry=NO_GRACE)

    in_steps = results("steps")
    # A part that comes late on a busy machine is another traffic.
    for _ in range(5):
        in_native = results(way)
        if in_native == in_steps:
            return
        in_steps = results("steps")
    assert in_native == in_steps


@pytest.mark.parametrize("kind", PEERS)
def test_stream_that_is_alone_does_not_use_the_session(kind: str) -> None:
    async def drive(arm: AsyncMyCobot) -> Any:
        begun_at: list[float] = []
        stream = arm.stream(GetAngles(), rate=100)
        for _ in range(5):
            before = time.monotonic()
            sample = await anext(stream)
            assert before <= sample.requested_at <= sample.replied_at <= time.monotonic()
            begun_at.append(sample.requested_at)
        # Only the session makes requests that wait.
        return steps_of(arm)._exchange.sent_last, sorted(set(begun_at)) == begun_at

    result, received = run(PEERS[kind](*[[ANGLES]] * 5), drive)
    assert result == (None, True)
    assert received == REQUEST * 5


def test_call_of_another_task_waits_for_the_reply_that_is_under_way() -> None:
    peer = ScriptedPeer([SLOW, ANGLES], [POWER])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        powered = await arm.is_power_on()
        return (await task).values[0][0], powered

    assert run(peer, drive, timeout=20) == ((1.4, True), REQUEST + ASK_POWER)


def test_stream_and_calls_on_one_arm_share_it() -> None:
    # Calls and slots take turns; each gets the reply to its own request.
    async def drive(arm: AsyncMyCobot) -> Any:
        stream, other = arm.stream(GetAngles(), rate=100), arm.stream(IsPowerOn(), rate=100)
        values: list[Any] = []
        for _ in range(10):
            values += [*(await anext(stream)).values, *(await anext(other)).values]
            values.append(await arm.is_power_on())
        return values

    angles = (1.4, 0.61, -0.26, -1.93, 1.75, -1.75)
    peer = ScriptedPeer(*[[ANGLES], [POWER], [POWER]] * 10)
    values, received = run(peer, drive, timeout=20)
    assert values == [angles, True, True] * 10
    assert received == (REQUEST + ASK_POWER + ASK_POWER) * 10


def test_second_stream_waits_for_the_reply_that_is_under_way() -> None:
    peer = ScriptedPeer([SLOW, ANGLES], [POWER])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        other = await anext(arm.stream(IsPowerOn(), rate=10))
        return (await task).values[0][0], other.values

    assert run(peer, drive, timeout=20) == ((1.4, (True,)), REQUEST + ASK_POWER)


def test_late_reply_to_a_cancelled_slot_is_not_taken_by_the_next_call() -> None:
    peer = ScriptedPeer([SLOW, ANGLES], [OTHERS])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        return (await arm.get_angles())[0]

    retry = RetryPolicy(attempts=1, grace=2 * SLOW)
    assert run(peer, drive, timeout=20, retry=retry) == (3.96, REQUEST * 2)


def test_silence_after_a_cancelled_slot_holds_the_next_call_for_the_grace_time_only() -> None:
    peer = ScriptedPeer([], [ANGLES])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        return (await arm.get_angles())[0]

    retry = RetryPolicy(attempts=1, grace=SLOW)
    assert run(peer, drive, timeout=2 * LONGEST, retry=retry) == (1.4, REQUEST * 2)


def test_slot_that_is_cancelled_before_its_moment_sends_nothing() -> None:
    async def drive(arm: AsyncMyCobot) -> Any:
        stream = arm.stream(GetAngles(), rate=25)
        await anext(stream)
        task = asyncio.create_task(anext(stream))
        await asyncio.sleep(0)
        task.cancel()
        await asyncio.sleep(0.1)
        # The stream goes on.
        return task.cancelled(), (await anext(stream)).number

    assert run(ScriptedPeer(*[[ANGLES]] * 3), drive) == ((True, 1), REQUEST * 2)


def test_request_that_is_under_way_is_left_to_the_next_session() -> None:
    peer = ScriptedPeer()

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        left = steps_of(arm).exchange.leave(time.monotonic())
        await arm.close()
        with pytest.raises(LinkError):
            await task
        return [late.request for late in left.late]

    assert run(peer, drive, timeout=20, retry=LONG) == ([REQUEST], REQUEST)


def test_silent_arm_costs_each_slot_its_deadline_and_no_more() -> None:
    async def drive(arm: AsyncMyCobot) -> Any:
        stream = arm.stream(GetAngles(), rate=20)
        samples = [await anext(stream) for _ in range(3)]
        return [sample.number for sample in samples], stream.report.unanswered

    # The first slot after silence uses the session, the others do not.
    peer = ScriptedPeer([ANGLES], [], [], [ANGLES], [], [ANGLES])
    result = run(peer, drive, timeout=0.3, retry=NO_GRACE)
    assert result == (([0, 1, 2], 3), REQUEST * 6)


def test_unplugged_port_ends_the_slot_that_waits() -> None:
    async def drive(arm: AsyncMyCobot) -> None:
        with pytest.raises(LinkError):
            await anext(arm.stream(GetAngles(), rate=20))

    run(ScriptedPeer([0.02, None]), drive, timeout=20)


def test_request_of_which_the_line_takes_a_part_is_written_whole_later() -> None:
    async def drive(peer: int, line: int, url: str) -> Any:
        async with AsyncMyCobot(url, codec="native", timeout=20) as arm, asyncio.timeout(LONGEST):
            taken = fill(line, room - 2)
            task = asyncio.create_task(anext(arm.stream(GetAngles(), rate=10)))
            native = steps_of(arm).native
            assert native is not None
            # Systems where the line takes all of it at once show less.
            for _ in range(100):
                await asyncio.sleep(0.01)
                if native.polled.unwritten:
                    break
            received = b""
            while len(received) < taken + len(REQUEST):
                received += await asyncio.to_thread(os.read, peer, 4096)
            os.write(peer, ANGLES)
            return (await task).values[0][0], received[taken:]

    room = 0
    # The first one shows how many bytes a line holds.
    for run_here in (False, True):
        peer, line = os.openpty()
        tty.setraw(line)
        os.set_blocking(line, False)
        try:
            if run_here:
                assert asyncio.run(drive(peer, line, os.ttyname(line))) == (1.4, REQUEST)
            else:
                room = fill(line, 1 << 20)
        finally:
            os.close(peer)
            os.close(line)


def fill(line: int, most: int) -> int:
    """Write bytes to a line until it takes no more, or that many; return how many it took."""
    taken, before = 0, -1
    while before < taken < most:
        before = taken
        with suppress(BlockingIOError):
            while taken < most:
                taken += os.write(line, bytes(min(1024, most - taken)))
        # The system moves bytes on meanwhile, so that there is room for more.
        time.sleep(0.1)
    return taken


def test_listener_that_is_added_meanwhile_gets_the_reply() -> None:
    peer = ScriptedPeer([SLOW, ANGLES])
    traffic: list[Traffic] = []

    async def drive(arm: AsyncMyCobot) -> None:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        arm.add_traffic_listener(traffic.append)
        await task

    run(peer, drive, timeout=20)
    assert [(item.direction, item.data) for item in traffic] == [("received", ANGLES)]


def test_copy_of_a_one_way_request_is_not_taken_for_the_reply_of_a_slot() -> None:
    peer = ScriptedPeer([], [0.02, ANGLES, SLOW, OTHERS])

    async def drive(arm: AsyncMyCobot) -> Any:
        stop = EncodedRequest(TABLE.command("stop"), ANGLES, b"", {})
        await arm._connection.send(stop, None)
        while not peer.received:
            await asyncio.sleep(0.002)
        # Its acknowledgement is not waited for.
        steps_of(arm).exchange.alone.outstanding_replies.replies = ()
        steps_of(arm).exchange.alone.acks.waiting = []
        return (await anext(arm.stream(GetAngles(), rate=10))).values[0][0]

    assert run(peer, drive, timeout=20) == (3.96, ANGLES + REQUEST)


def test_recorded_stream_uses_the_session() -> None:
    # See also the tests of recordings: native calls would bypass them.
    async def drive(arm: AsyncMyCobot) -> Any:
        traffic: list[Traffic] = []
        arm.add_traffic_listener(traffic.append)
        await anext(arm.stream(GetAngles(), rate=20))
        return [item.data for item in traffic]

    assert run(ScriptedPeer([ANGLES]), drive) == ([REQUEST, ANGLES], REQUEST)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_forked_child_neither_reads_nor_writes_the_line_of_a_stream() -> None:
    peer = ScriptedPeer([SLOW, ANGLES])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await begun(arm.stream(GetAngles(), rate=10), peer)
        child = os.fork()
        if not child:
            steps = steps_of(arm)
            steps.take_back()
            steps.turn()
            os._exit(steps.lost is None)
        _, status = await asyncio.to_thread(os.waitpid, child, 0)
        return status, (await task).values[0][0]

    assert run(peer, drive, timeout=20) == ((0, 1.4), REQUEST)
