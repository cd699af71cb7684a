"""Drive streams of an asyncio client against a scripted peer."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

from cobotwire import AsyncMyCobot
from cobotwire.client.aio_steps import AsyncSteps

REQUEST = bytes.fromhex("FE FE 02 20 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
OTHERS = bytes.fromhex("FE FE 0E 20 01 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
# A test that takes longer hangs, in seconds.
LONGEST = 15


def steps_of(arm: AsyncMyCobot) -> AsyncSteps:
    steps = arm._connection._steps
    assert steps is not None
    return steps


def run(peer: Any, drive: Callable[[AsyncMyCobot], Awaitable[Any]], **options: Any) -> Any:
    """Return what ``drive`` returns for an arm at the peer, and the requests of the peer."""

    async def main() -> Any:
        async with AsyncMyCobot(peer.url, codec="native", **options) as arm:
            async with asyncio.timeout(LONGEST):
                return await drive(arm)

    with peer:
        result = asyncio.run(main())
    return result, peer.received
