"""The client stays usable after Ctrl-C or a cancelled task at any time."""

from __future__ import annotations

import _thread
import asyncio
import os
import random
import subprocess
import sys
import threading
import time
from contextlib import suppress
from typing import Any

import pytest

from cobotwire import MyCobot
from cobotwire.editions.mycobot import TABLE, AsyncMyCobot
from cobotwire.simulator import PtyServer, SimulatedArm
from recording_transport import RecordingTransport
from scripted_peer import ScriptedPeer

INTERRUPTED = """
import random, signal, time
from cobotwire import MyCobot, CobotwireError
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator import PtyServer, SimulatedArm
random.seed(1)
signal.signal(signal.SIGALRM, signal.default_int_handler)
with PtyServer(SimulatedArm(TABLE)) as server, MyCobot(server.url) as arm:
    interrupts = 0
    until = time.monotonic() + 2
    while time.monotonic() < until:
        try:
            # One interrupt in each round; it may come after the calls, during the sleep.
            signal.setitimer(signal.ITIMER_REAL, random.uniform(0.00001, 0.0006))
            for joint in range(1, 7):
                arm.set_color(joint, 1, 2)
                assert arm.get_joint_max_angle(joint) == 165.0
                assert arm.get_joint_min_angle(joint) == -165.0
            time.sleep(0.01)
        except KeyboardInterrupt:
            interrupts += 1
    for joint in range(1, 7):
        assert arm.get_joint_max_angle(joint) == 165.0
    print(interrupts)
"""


def test_ctrl_c_anywhere_leaves_the_arm_usable() -> None:
    result = subprocess.run(
        [sys.executable, "-c", INTERRUPTED],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "PYTHONPATH": ""},
    )
    assert result.returncode == 0, result.stderr
    assert int(result.stdout) > 10


def test_ctrl_c_in_the_reading_thread_lets_another_thread_continue() -> None:
    reply = bytes.fromhex("FE FE 03 12 01 FA")
    with ScriptedPeer([0.6, reply]) as peer, MyCobot(peer.url, timeout=3) as arm:
        results: list[bool] = []
        calling = threading.Thread(target=lambda: results.append(arm.is_power_on()))
        threading.Timer(0.3, _thread.interrupt_main).start()
        threading.Timer(0.1, calling.start).start()
        with pytest.raises(KeyboardInterrupt):
            arm.get_coords()
        deadline = time.monotonic() + 5
        while not results and time.monotonic() < deadline:
            time.sleep(0.01)
        assert results == [True]


async def _cancelled(url: str) -> None:
    async with AsyncMyCobot(url, timeout=2) as arm:
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.05):
                await arm.get_encoder(1)
        # The reply to the cancelled request arrives at 0.2 s; it must not go to the next request.
        assert await arm.get_encoder(2) == 2


def test_cancelled_call_leaves_the_client_usable() -> None:
    one, two = (bytes.fromhex("FE FE 04 3B 00") + bytes([n]) + b"\xfa" for n in (1, 2))
    with ScriptedPeer([0.2, one], [two]) as peer:
        asyncio.run(_cancelled(peer.url))


def test_cancelled_opening_is_a_cancellation() -> None:
    async def run() -> None:
        opening = asyncio.create_task(AsyncMyCobot(RecordingTransport()).open())
        await asyncio.sleep(0)
        opening.cancel()
        with pytest.raises(asyncio.CancelledError):
            await opening

    asyncio.run(run())


async def _cancelled_at_any_time(url: str) -> None:
    chance = random.Random(5)
    async with AsyncMyCobot(url) as arm:
        for _ in range(150):
            work = asyncio.gather(
                *(arm.get_joint_max_angle(joint) for joint in range(1, 7)), arm.set_color(1, 2, 3)
            )
            await asyncio.sleep(chance.uniform(0, 0.001))
            work.cancel()
            with suppress(asyncio.CancelledError):
                await work
        assert [await arm.get_joint_max_angle(joint) for joint in range(1, 7)] == [165.0] * 6
        exchange: Any = arm._connection._exchange
        assert exchange.idle_seconds(0.0) is None, "nothing waits"


def test_cancelling_tasks_at_any_time_leaves_the_client_usable() -> None:
    with PtyServer(SimulatedArm(TABLE)) as server:
        asyncio.run(_cancelled_at_any_time(server.url))
