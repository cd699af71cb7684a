"""The asyncio client stays usable after a cancelled call."""

from __future__ import annotations

import asyncio

import pytest

from cobotwire.editions.mycobot import AsyncMyCobot
from recording_transport import RecordingTransport
from scripted_peer import ScriptedPeer


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


def test_cancelled_opening_raises_cancelled_error() -> None:
    async def run() -> None:
        opening = asyncio.create_task(AsyncMyCobot(RecordingTransport()).open())
        await asyncio.sleep(0)
        opening.cancel()
        with pytest.raises(asyncio.CancelledError):
            await opening

    asyncio.run(run())


def test_cancelled_call_without_a_reply_delays_no_other_call() -> None:
    async def call(url: str) -> None:
        async with AsyncMyCobot(url, timeout=20) as arm:
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0.05):
                    await arm.get_encoder(1)
            async with asyncio.timeout(2):
                assert await arm.is_power_on()

    with ScriptedPeer([], [bytes.fromhex("FE FE 03 12 01 FA")]) as peer:
        asyncio.run(call(peer.url))
