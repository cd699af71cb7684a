"""After any error in a block, or while it is left, stop is sent and the port is closed."""

from __future__ import annotations

from typing import Any

import pytest

from both_ways import Opener
from cobotwire import MyCobot
from cobotwire.editions.mybuddy import MyBuddy
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
