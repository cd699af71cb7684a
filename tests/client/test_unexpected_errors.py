"""After any error in a block, or while it is left, stop is sent and the port is closed."""

from __future__ import annotations

import asyncio
import threading
import time
from typing import Any

import pytest

from both_ways import Opener
from cobotwire import LinkError, MyCobot
from cobotwire.editions.mybuddy import AsyncMyBuddy, MyBuddy
from cobotwire.session import Traffic
from cobotwire.session.exchange import ENDING
from recording_transport import RecordingTransport

STOP = bytes.fromhex("FE FE 02 29 FA")


class FailingTransport(RecordingTransport):
    """Raise an error that no transport may raise: at some writes, and when it is closed."""

    def __init__(self, failing_writes: int = 0, closing: type[Exception] | None = None) -> None:
        super().__init__()
        self._failing, self._closing = failing_writes, closing

    def write(self, data: bytes) -> None:
        if self._failing:
            self._failing -= 1
            raise RuntimeError("Already mutably borrowed")
        super().write(data)

    def close(self) -> None:
        super().close()
        if self._closing:
            raise self._closing("the disk is on fire")


def leave_by(error: BaseException, arm: Any) -> None:
    with arm:
        raise error


@pytest.mark.parametrize("failures", [0, 1, 2])
@pytest.mark.parametrize("closing", [None, RuntimeError])
def test_stop_is_sent_and_the_port_is_closed_whatever_stop_and_close_raise(
    open_arm: Opener, failures: int, closing: type[Exception] | None
) -> None:
    transport = FailingTransport(failures, closing)
    error = ValueError("the user's own")
    with pytest.raises(ValueError, match="the user's own") as raised:
        leave_by(error, open_arm(transport))
    assert raised.value is error
    # For asyncio a thread writes, and counts any error of the transport as a lost line.
    repeated = open_arm is MyCobot
    sent = failures == 0 or (failures == 1 and repeated)
    # The arm may have a part of the first stop: the bytes before the second one complete it.
    assert transport.written.endswith(STOP) if sent else transport.written == b""
    assert transport.closed
    notes = getattr(error, "__notes__", [])
    assert len(notes) == (failures > 0 and repeated) + (closing is not None)
    assert failures == 0 or not repeated or ("not sent again" in notes[0]) == (failures == 2)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), SystemExit(3), GeneratorExit()])
def test_stop_is_sent_for_errors_that_are_no_exceptions(error: BaseException) -> None:
    transport = FailingTransport(1)
    with pytest.raises(type(error)) as raised:
        leave_by(error, MyCobot(transport))
    assert raised.value is error
    assert transport.written.endswith(STOP)
    assert transport.closed


def test_stop_is_sent_to_other_addresses_if_one_raises() -> None:
    transport = FailingTransport(2)
    arm = MyBuddy(transport)
    arm.at("right")
    with pytest.raises(ValueError, match="own"):
        leave_by(ValueError("own"), arm)
    assert transport.written.endswith(bytes.fromhex("FE FE 02 02 29 29")), "the second stop"
    assert transport.closed


def test_nothing_is_sent_between_the_stop_for_an_error_and_closing() -> None:
    transport, errors = RecordingTransport(), list[Exception]()

    def move_after_stop(traffic: Traffic) -> None:
        # As another thread could, at the worst time.
        if traffic.data == STOP:
            for call in (lambda: arm.send_angles([0] * 6, 50), arm.get_angles):
                with pytest.raises(LinkError, match="only stop is sent any more") as raised:
                    call()
                errors.append(raised.value)
            arm.jog_stop()

    arm = MyCobot(transport, trace=move_after_stop)
    with pytest.raises(ValueError, match="own"):
        leave_by(ValueError("own"), arm)
    assert len(errors) == 2
    assert transport.written == STOP + bytes.fromhex("FE FE 02 34 FA")


def test_request_that_waits_for_its_turn_is_not_sent_after_the_stop() -> None:
    class SilentTransport(RecordingTransport):
        def read(self, timeout: float) -> bytes:
            time.sleep(min(timeout, 0.01))
            if self.closed:
                raise LinkError(self.url, "it is closed")
            return b""

    transport, errors = SilentTransport(), list[Exception]()

    def query() -> None:
        try:
            arm.get_angles()
        except LinkError as error:
            errors.append(error)

    arm = MyCobot(transport, timeout=1.0)
    threads = [threading.Thread(target=query) for _ in range(3)]
    for thread in threads:
        thread.start()
    time.sleep(0.05)
    with pytest.raises(ValueError, match="own"):
        leave_by(ValueError("own"), arm)
    for thread in threads:
        thread.join()
    assert [str(error) for error in errors].count(f"recorder: {ENDING}") == 2
    assert transport.written == bytes.fromhex("FE FE 02 20 FA") + STOP


def test_other_task_sends_nothing_between_the_stops_of_two_addresses() -> None:
    class SlowTransport(RecordingTransport):
        def write(self, data: bytes) -> None:
            time.sleep(0.01)
            super().write(data)

    transport = SlowTransport()

    async def move(arm: AsyncMyBuddy) -> None:
        while True:
            await arm.send_angles([0] * 6, 50)
            await asyncio.sleep(0)

    async def main() -> None:
        async with AsyncMyBuddy(transport) as arm:
            arm.at("right")
            moving = asyncio.create_task(move(arm))
            await asyncio.sleep(0.05)
            try:
                raise ValueError("own")
            finally:
                moving.add_done_callback(asyncio.Task.exception)

    with pytest.raises(ValueError, match="own"):
        asyncio.run(main())
    assert transport.written.endswith(bytes.fromhex("FE FE 00 02 29 29 FE FE 02 02 29 29"))
