"""Test that a simulated arm says why it cannot reply, and that the query is not sent again.

A real arm of the same edition replies, so each query is sent until the arm has refused it.
"""

from __future__ import annotations

import asyncio
import time
from collections import Counter
from typing import Any

import pytest

from cobotwire.editions import load, names
from cobotwire.protocol.errors import ReplyTimeout
from cobotwire.session import RequestReceived
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm, SteppedClock
from cobotwire.studio.arm_line import ArmLine, PortOptions

WITHOUT_GEOMETRY = [name for name in names() if load(name).TABLE.robot.geometry is None]
REASON = "the geometry of this arm is not known"
EDITION: Any = load("pro630")


def _counting() -> tuple[SimulatedArm, Counter[str]]:
    """Return an arm, and how often it receives each request."""
    received: Counter[str] = Counter()

    def count(event: DeviceEvent, reply: bytes) -> None:
        if isinstance(event, RequestReceived):
            received[event.message.command.name] += 1

    return SimulatedArm(EDITION.TABLE, powered=True, on_event=count), received


@pytest.mark.parametrize("edition", WITHOUT_GEOMETRY)
def test_error_of_unanswerable_query_says_why_in_every_edition(edition: str) -> None:
    package: Any = load(edition)
    query = package.TABLE.in_role("coordinates").name
    clock = SteppedClock()
    simulated = SimulatedArm(package.TABLE, clock=clock, powered=True)
    with package.CLIENT(MemoryTransport(simulated, clock)) as arm:
        with pytest.raises(ReplyTimeout, match=f"because the arm is simulated: {REASON}$") as error:
            getattr(arm, query)()
        assert error.value.refusal == REASON
        assert getattr(arm, package.TABLE.in_role("joints").name)() is not None


def test_stream_of_a_query_that_the_arm_refuses_ends_with_the_reason() -> None:
    async def sample(url: str) -> None:
        async with EDITION.ASYNC_CLIENT(url) as arm:
            async for _ in arm.stream(EDITION.messages.GetCoords(), rate=20):
                pytest.fail("the arm replied")

    with PtyServer(SimulatedArm(EDITION.TABLE, powered=True)) as server:
        with EDITION.CLIENT(server.url) as arm, pytest.raises(ReplyTimeout, match=REASON):
            next(iter(arm.stream(EDITION.messages.GetCoords(), rate=20)))
        with pytest.raises(ReplyTimeout, match=REASON):
            asyncio.run(sample(server.url))


def test_studio_stops_polling_a_query_that_the_arm_refuses() -> None:
    simulated, received = _counting()
    with PtyServer(simulated) as server, ArmLine(EDITION, PortOptions(server.url), 50.0):
        until = time.monotonic() + 20
        while received["get_angles"] < 5 and time.monotonic() < until:
            time.sleep(0.02)
    assert received["get_angles"] >= 5
    assert received["get_coords"] == 3, "a query is sent three times"
