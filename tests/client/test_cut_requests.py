"""A partly written request never becomes a part of another request."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from both_ways import InLoop
from cobotwire import LinkError, ReplyTimeout, RetryPolicy
from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
from cobotwire.transport.aio import WRITE_TIMEOUT
from cut_motion import ANGLES, CODEC, MOTION, STOP, frames
from recording_transport import RecordingTransport
from transport.ends import PtyEnd

# More than the buffer of a pseudo-terminal holds, which is 64 KiB.
REQUESTS = 4000
QUERY = CODEC.encode("is_in_position", "request", [ANGLES, 0])


class StallingTransport(RecordingTransport):
    """A transport that takes ``taken`` bytes of the first request, then everything."""

    def __init__(self, taken: int, reported: int | None) -> None:
        super().__init__()
        self._taken: int | None = taken
        self._reported = reported

    def write(self, data: bytes) -> None:
        super().write(data[: self._taken])
        if self._taken is not None:
            self._taken = None
            raise LinkError(self.url, "it stalled", self._reported)


@pytest.mark.parametrize("who", [MyCobot280, lambda port: InLoop(AsyncMyCobot280, port)])
@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("taken", range(len(MOTION)))
def test_stop_after_a_cut_motion_arrives_and_nothing_else(
    taken: int, known: bool, who: Callable[[Any], Any]
) -> None:
    transport = StallingTransport(taken, taken if known else None)
    with who(transport) as arm:
        with pytest.raises(LinkError) as caught:
            arm.send_angles(ANGLES, 50)
        assert caught.value.written == (taken if known else None)
        arm.stop()
        arm.stop()
    assert frames(transport.written) == [STOP, STOP]


class BusyTransport(RecordingTransport):
    """A transport that takes only ``taken`` bytes of what is written without waiting."""

    def __init__(self, taken: int) -> None:
        super().__init__()
        self._taken = taken

    def fileno(self) -> None:
        return None

    def write_some(self, data: bytes) -> int:
        self.write(data[: self._taken])
        return min(self._taken, len(data))


@pytest.mark.parametrize("taken", [5, len(QUERY) - len(STOP), len(QUERY)])
def test_stop_after_a_cut_repeated_query_arrives_and_nothing_else(taken: int) -> None:
    transport = BusyTransport(taken)
    with MyCobot280(transport, timeout=0.4, retry=RetryPolicy(attempts=2)) as arm:
        with pytest.raises(ReplyTimeout):
            arm.is_in_position(ANGLES, 0)
        arm.stop()
    assert frames(transport.written) == [QUERY] * (2 if taken == len(QUERY) else 1) + [STOP]


@pytest.mark.parametrize("who", [MyCobot280, lambda port: InLoop(AsyncMyCobot280, port)])
@pytest.mark.parametrize("before", range(3))
def test_stop_arrives_first_once_a_stuck_port_recovers(
    before: int, who: Callable[[Any], Any]
) -> None:
    pty = PtyEnd()
    whole = 0
    with who(pty.url) as arm:
        for _ in range(before):
            # Each five bytes move the position at which the motion is cut.
            arm.stop()
        written = None
        while written is None:
            try:
                arm.send_angles(ANGLES, 50)
                whole += 1
            except LinkError as error:
                written = error.written
        assert written in range(len(MOTION))
        received = pty.drain()
        arm.stop()
        received += pty.drain()
    assert frames(received) == [STOP] * before + [MOTION] * whole + [STOP]
    pty.unplug()


def test_asyncio_client_sends_every_request_on_a_slow_line() -> None:
    pty = PtyEnd()

    async def flood() -> None:
        async with AsyncMyCobot280(pty.url) as arm:
            await asyncio.gather(*(arm.send_angles(ANGLES, 50) for _ in range(REQUESTS)))

    received = b""
    sending = threading.Thread(target=asyncio.run, args=(flood(),))
    started = time.monotonic()
    sending.start()
    while sending.is_alive():
        received += pty.poll(0, 300)
        time.sleep(0.02)
    # Longer than the time after which a line that takes nothing at all is an error.
    assert time.monotonic() - started > 1.5 * WRITE_TIMEOUT
    assert frames(received + pty.drain()) == [MOTION] * REQUESTS
    pty.unplug()
