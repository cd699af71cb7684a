"""Writes that wait for a full line: a stop is sent, a cancelled request is not."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

from cobotwire import LinkError
from cobotwire.editions.mycobot280 import AsyncMyCobot280
from cobotwire.transport import aio
from cut_motion import ANGLES, CODEC, MOTION, STOP, frames
from recording_transport import RecordingTransport
from transport.ends import PtyEnd

ENCODER = CODEC.encode("get_encoder", "request", [1])


class FullPort:
    """An open port that takes only ``room`` more bytes."""

    def __init__(self, port: Any, room: float) -> None:
        self._port, self.room = port, room

    def __getattr__(self, name: str) -> Any:
        return getattr(self._port, name)

    def write_some(self, data: bytes) -> int:
        part = data[: int(min(len(data), self.room))]
        self.room -= len(part)
        return self._port.write_some(part) if part else 0


Scenario = Callable[[AsyncMyCobot280, FullPort], Coroutine[Any, Any, None]]


def received_after(scenario: Scenario, room: int, deadline: float | None = None) -> list[bytes]:
    """Run a scenario with a port that takes ``room`` bytes; return the frames that an arm reads."""
    pty = PtyEnd()

    async def run() -> None:
        client = AsyncMyCobot280(pty.url, deadline=deadline, timeout=0.1, on_error="leave")
        async with client as arm:
            steps: Any = arm._connection._steps
            port = steps.transport._transport = FullPort(steps.transport._transport, room)
            await scenario(arm, port)

    asyncio.run(run())
    received = frames(pty.drain())
    pty.unplug()
    return received


async def started(call: Coroutine[Any, Any, Any]) -> asyncio.Task[Any]:
    """Return the task of a call that has begun."""
    task = asyncio.create_task(call)
    await asyncio.sleep(0)
    return task


async def cancel(task: asyncio.Task[Any]) -> None:
    """Cancel a task, and wait until it is done."""
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task


# A call with a deadline waits until the line takes bytes.
@pytest.mark.parametrize(("deadline", "room"), [(None, 0), (None, 5), (0.1, 5)])
def test_stop_is_sent_though_the_motion_before_it_failed(
    deadline: float | None, room: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(aio, "WRITE_TIMEOUT", 0.2)

    async def scenario(arm: AsyncMyCobot280, port: FullPort) -> None:
        motion = await started(arm.send_angles(ANGLES, 50))
        stop = await started(arm._stop_all())
        later = await started(arm.send_angles(ANGLES, 50)) if deadline is None else None
        with pytest.raises(LinkError) as caught:
            await motion
        assert caught.value.written == room
        port.room = 1000
        await stop
        if later is not None:
            with pytest.raises(LinkError) as caught:
                await later
            assert caught.value.written == 0

    assert received_after(scenario, room, deadline) == [STOP]


@pytest.mark.parametrize("room", [0, 5])
def test_cancelled_motion_is_not_sent_unless_it_was_begun(room: int) -> None:
    async def scenario(arm: AsyncMyCobot280, port: FullPort) -> None:
        first = await started(arm.send_angles(ANGLES, 50))
        second = await started(arm.send_angles(ANGLES, 50))
        await cancel(second)
        await cancel(first)
        stop = await started(arm.stop())
        await cancel(stop)
        port.room = 1000
        await arm.stop()

    assert received_after(scenario, room) == [MOTION] * (room > 0) + [STOP, STOP]


@pytest.mark.parametrize("room", [0, 5])
def test_cancelled_request_with_a_reply_is_not_sent_unless_it_was_begun(room: int) -> None:
    async def scenario(arm: AsyncMyCobot280, port: FullPort) -> None:
        first = await started(arm.get_encoder(1))
        second = await started(arm.get_encoder(2))
        await cancel(first)
        await cancel(second)
        port.room = 1000
        await arm.stop()

    assert received_after(scenario, room) == [ENCODER] * (room > 0) + [STOP]


class SlowTransport(RecordingTransport):
    """A transport without a descriptor; a write waits until ``room`` is set."""

    def __init__(self) -> None:
        super().__init__()
        self.room = threading.Event()

    def write(self, data: bytes) -> None:
        assert self.room.wait(5)
        super().write(data)


def test_cancelled_motion_is_not_sent_by_a_transport_with_threads() -> None:
    transport = SlowTransport()

    async def run() -> None:
        async with AsyncMyCobot280(transport) as arm:
            stop = await started(arm.stop())
            await cancel(await started(arm.send_angles(ANGLES, 50)))
            transport.room.set()
            await stop
            await arm.stop()

    asyncio.run(run())
    assert frames(transport.written) == [STOP, STOP]


def test_waiting_writes_are_sent_and_end_though_a_listener_raises() -> None:
    async def scenario(arm: AsyncMyCobot280, port: FullPort) -> None:
        calls = [await started(arm.send_angles(ANGLES, 50)) for _ in range(3)]

        def fail(traffic: Any) -> None:
            raise RuntimeError

        arm.add_traffic_listener(fail)
        await cancel(calls.pop(0))
        port.room = 1000
        await asyncio.wait_for(asyncio.gather(*calls), 2.0)

    assert received_after(scenario, 0) == [MOTION] * 2


def test_closing_fails_every_write_that_waits() -> None:
    async def scenario(arm: AsyncMyCobot280, port: FullPort) -> None:
        calls = [await started(call) for call in (arm.send_angles(ANGLES, 50), arm.stop())]
        port.room = 1000
        await arm.close()
        for call in calls:
            with pytest.raises(LinkError):
                await call

    assert received_after(scenario, 0) == []
