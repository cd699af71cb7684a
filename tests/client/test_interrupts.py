"""The client stays usable after Ctrl-C or a cancelled task at any time."""

from __future__ import annotations

import _thread
import asyncio
import threading
import time

import pytest

from cobotwire import MyCobot
from cobotwire.editions.mycobot import AsyncMyCobot
from recording_transport import RecordingTransport
from scripted_peer import ScriptedPeer


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
