"""A thread writes requests of asyncio streams at their moments while the loop is held up."""

from __future__ import annotations

import asyncio
import os
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from cobotwire import AsyncMyCobot, LinkError
from cobotwire import codec as codecs
from cobotwire.client import aio_slots
from cobotwire.client.aio_streaming import AsyncStream
from cobotwire.editions.mycobot import GetAngles
from cobotwire.session.sample import Sample
from driving_streams import ANGLES, OTHERS, REQUEST, run, steps_of
from scripted_peer import PEERS, ScriptedPeer

pytestmark = pytest.mark.skipif(not codecs.native_available(), reason="there is no native module")
ASK_POWER = bytes.fromhex("FE FE 02 12 FA")
POWER = bytes.fromhex("FE FE 03 12 01 FA")
# One slot lasts far longer than what a test does in it, except for holding up the loop.
RATE = 2.5
SLOT = 1 / RATE
OPEN_FILES = Path("/proc/self/fd")
# What the peer gets until a plan is made.
SENT = REQUEST * 2


@pytest.fixture(autouse=True)
def plans_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let streams plan each slot when it is wanted, not shortly before its moment."""
    monkeypatch.setattr(aio_slots, "CHECK_SECONDS", 60.0)


async def planned(stream: AsyncStream) -> asyncio.Task[Sample]:
    """Return the task that waits for a sample, the request of which the thread is to write."""
    await anext(stream)
    # The loop is late for this one.
    task = asyncio.create_task(anext(stream))
    await asyncio.sleep(0)
    hold_up()
    await task
    before = open_files()
    task = asyncio.create_task(anext(stream))
    await asyncio.sleep(0)
    assert open_files() == before + OPEN_FILES.is_dir(), "a plan has a descriptor"
    return task


def open_files() -> int:
    """Return how many descriptors the process has; 0 if the system does not list them."""
    return len(os.listdir(OPEN_FILES)) if OPEN_FILES.is_dir() else 0


def hold_up() -> float:
    """Block the loop until the moment is long over; return when that was."""
    time.sleep(SLOT * 1.3)
    return time.monotonic()


@pytest.mark.parametrize("kind", PEERS)
def test_request_is_written_at_its_moment_while_the_loop_is_held_up(kind: str) -> None:
    peer = PEERS[kind]([ANGLES], [ANGLES], [OTHERS])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await planned(arm.stream(GetAngles(), rate=RATE))
        over = hold_up()
        received = peer.received
        sample = await task
        early = over - sample.requested_at
        # Only the session makes requests that wait.
        return received, early > SLOT / 4, sample.values[0][0], steps_of(arm)._exchange.sent_last

    result, received = run(peer, drive, timeout=20)
    assert result == (SENT + REQUEST, True, 3.96, None)
    assert received == SENT + REQUEST


def test_bytes_that_come_before_the_moment_do_not_pass_for_the_reply() -> None:
    peer = ScriptedPeer([ANGLES], [ANGLES], [OTHERS])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await planned(arm.stream(GetAngles(), rate=RATE))
        peer.send(ANGLES)
        hold_up()
        received = peer.received
        return received, (await task).values[0][0]

    assert run(peer, drive, timeout=20) == ((SENT, 3.96), SENT + REQUEST)


def test_call_of_another_task_withdraws_the_plan_and_the_slot_is_sent_once() -> None:
    peer = ScriptedPeer([ANGLES], [ANGLES], [POWER], [OTHERS])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await planned(arm.stream(GetAngles(), rate=RATE))
        powered = await arm.is_power_on()
        hold_up()
        received = peer.received
        return powered, received, (await task).values[0][0]

    result, received = run(peer, drive, timeout=20)
    assert result == (True, SENT + ASK_POWER, 3.96)
    assert received == SENT + ASK_POWER + REQUEST


def test_call_after_the_thread_has_written_waits_for_that_reply() -> None:
    peer = ScriptedPeer([ANGLES], [ANGLES], [SLOT, OTHERS], [POWER])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await planned(arm.stream(GetAngles(), rate=RATE))
        hold_up()
        # Nothing of the loop has run since the thread has written.
        powered = arm.is_power_on()
        return await powered, (await task).values[0][0]

    assert run(peer, drive, timeout=20) == ((True, 3.96), SENT + REQUEST + ASK_POWER)


@pytest.mark.parametrize("how", ["close", "cancel"])
def test_slot_that_ends_before_its_moment_is_not_written(how: str) -> None:
    peer = ScriptedPeer([ANGLES], [ANGLES], [OTHERS])

    async def drive(arm: AsyncMyCobot) -> None:
        stream = arm.stream(GetAngles(), rate=RATE)
        task = await planned(stream)
        if how == "close":
            stream.close()
            hold_up()
            with pytest.raises(StopAsyncIteration):
                await task
        else:
            task.cancel()
            await asyncio.sleep(0)
            hold_up()
            with pytest.raises(asyncio.CancelledError):
                await task

    assert run(peer, drive, timeout=20) == (None, SENT)


def test_plan_never_writes_to_a_file_that_got_the_number_of_a_closed_port(tmp_path: Path) -> None:
    peer = ScriptedPeer([ANGLES], [ANGLES], [OTHERS])
    path = tmp_path / "other"

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await planned(arm.stream(GetAngles(), rate=RATE))
        port = arm._connection._port
        assert port is not None
        number = port.transport.fileno()  # type: ignore[attr-defined]
        # Another thread closes the port, of which the loop knows nothing.
        closing = threading.Thread(target=port.transport.close)
        closing.start()
        closing.join()
        other = os.open(path, os.O_WRONLY | os.O_CREAT)
        hold_up()
        with pytest.raises(LinkError):
            await task
        os.close(other)
        return number == other

    assert run(peer, drive, timeout=20) == (True, SENT)
    assert path.read_bytes() == b""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_plan_is_written_once_if_the_process_forks() -> None:
    peer = ScriptedPeer([ANGLES], [ANGLES], [OTHERS])

    async def drive(arm: AsyncMyCobot) -> Any:
        task = await planned(arm.stream(GetAngles(), rate=RATE))
        child = os.fork()
        if not child:
            hold_up()
            steps_of(arm).take_back()
            os._exit(steps_of(arm).lost is None)
        hold_up()
        _, status = await asyncio.to_thread(os.waitpid, child, 0)
        return status, (await task).values[0][0]

    assert run(peer, drive, timeout=20) == ((0, 3.96), SENT + REQUEST)
