"""When a stream begins the call of a slot."""

from __future__ import annotations

import asyncio

import pytest

from cobotwire import AsyncMyCobot
from cobotwire.client.slots import EARLIEST_SECONDS, Slots
from cobotwire.codec import load
from cobotwire.editions.mycobot import TABLE, GetAngles
from cobotwire.session import Answer, EncodedRequest, RetryPolicy
from cobotwire.session.request import RequestEncoder
from cobotwire.session.sampling import Poll
from scripted_peer import ScriptedPeer

REQUEST = bytes.fromhex("FE FE 02 20 FA")
REPLY = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
FIELDS = {"angles": (0.0,) * 6}


class HeldUp:
    """A connection in simulated time, whose thread gets each turn ``turn`` seconds late."""

    def __init__(self, turn: float) -> None:
        self.time, self.turn = 0.0, turn
        self.begun: list[float] = []

    def now(self) -> float:
        return self.time

    def sleep(self, seconds: float) -> None:
        self.time += seconds + self.turn

    def answer(
        self, request: EncodedRequest, policy: RetryPolicy, wait: float | None, at: float
    ) -> Answer:
        self.begun.append(at - self.time)
        requested_at = max(self.time, at)
        self.time = requested_at + 0.0001 + self.turn
        return FIELDS, requested_at, requested_at + 0.0001


@pytest.mark.parametrize("turn", [0.0, 0.005])
def test_stream_begins_calls_early_only_beside_a_busy_thread(turn: float) -> None:
    request = GetAngles()
    encoded = RequestEncoder(load(TABLE)).encode_request(request)
    line = HeldUp(turn)
    slots = Slots(line.now, line.sleep, line.answer, lambda: False)
    off = []
    for slot in range(1, 6):
        reading = slots.reading(Poll(request, encoded, RetryPolicy(), None), slot * 0.1)
        assert reading is not None
        off.append(reading.requested_at - slot * 0.1)
    if turn:
        # The first one shows that turns are late; the others are sent at their moments.
        assert off[0] == pytest.approx(turn)
        assert off[1:] == pytest.approx([0.0] * 4)
        assert all(0 < early <= EARLIEST_SECONDS for early in line.begun[1:])
    else:
        assert off == pytest.approx([0.0] * 5)
        assert line.begun == pytest.approx([0.0] * 5)


def test_asyncio_stream_that_is_closed_before_its_slot_sends_nothing() -> None:
    async def drive(url: str) -> int:
        async with AsyncMyCobot(url) as arm:
            stream = arm.stream(GetAngles(), rate=2)
            asyncio.get_running_loop().call_later(0.1, stream.close)
            return len([sample async for sample in stream])

    with ScriptedPeer([REPLY]) as peer:
        assert asyncio.run(drive(peer.url)) == 1
        assert peer.received == REQUEST


def test_asyncio_stream_that_is_closed_just_before_its_slot_sends_nothing() -> None:
    async def drive(url: str) -> int:
        async with AsyncMyCobot(url) as arm:
            # The wait for the next slot is so short that only the timer checks.
            stream = arm.stream(GetAngles(), rate=25)
            count = 0
            async for _ in stream:
                count += 1
                asyncio.get_running_loop().call_soon(stream.close)
            return count

    with ScriptedPeer([REPLY]) as peer:
        assert asyncio.run(drive(peer.url)) == 1
        assert peer.received == REQUEST
