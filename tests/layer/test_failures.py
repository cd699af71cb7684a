"""Calls of the layer raise, or return a value, if the robot does not reply."""

from __future__ import annotations

import logging
from contextlib import nullcontext
from typing import Any

import pytest

import cobotwire.pymycobot as layer
from cobotwire.protocol.errors import MotionTimeout, ProtocolError, ReplyTimeout, UsageError
from cobotwire.protocol.roles import row_index
from cobotwire.simulator import SimulatedArm
from layer.arms import made
from memory_peer import MemoryPeer


def test_setter_without_acknowledgement_raises_or_returns_minus_one() -> None:
    for errors in ("raise", None):
        with pytest.raises(ReplyTimeout):
            made("MyCobot280", errors=errors, acks=False)[0].set_color(1, 2, 3)
    found, arm = made("MyCobot280", errors="return", acks=False)
    assert found.set_color(1, 2, 3) == -1
    assert arm.state.light == (1, 2, 3)


def test_query_without_reply_raises_or_returns_minus_one() -> None:
    with pytest.raises(ReplyTimeout):
        made("MyCobot280", peer=lambda _: MemoryPeer())[0].get_angles()
    assert made("MyCobot280", errors="return", peer=lambda _: MemoryPeer())[0].get_angles() == -1


def test_asynchronous_motion_waits_for_nothing() -> None:
    found, _ = made("MyCobot280", acks=False)
    assert found.send_angles([0] * 6, 50, _async=True) is None
    assert found.clock() < 0.1


def test_wrong_argument_raises_with_both_error_policies() -> None:
    for errors in ("raise", "return"):
        with pytest.raises(UsageError):
            made("MyCobot280", errors=errors)[0].send_angle(9, 0, 50)


def test_motion_that_does_not_arrive_raises_or_returns_one_as_the_library() -> None:
    found, _ = made("MyCobot280", powered=False)
    with pytest.raises(MotionTimeout):
        found.sync_send_angles([20] * 6, 50, timeout=1)
    found, _ = made("MyCobot280", powered=False, errors="return")
    assert found.sync_send_angles([20] * 6, 50, timeout=1) == 1


SYNC = [name for name in layer.__all__ if hasattr(getattr(layer, name), "sync_send_angles")]


@pytest.mark.parametrize("errors", ["raise", "return"])
@pytest.mark.parametrize("name", SYNC)
def test_late_motion_is_stopped_once_with_both_error_policies(name: str, errors: Any) -> None:
    received: list[str] = []
    found, arm = made(
        name, errors=errors, on_event=lambda e, _: received.append(e.message.command.name)
    )
    table = arm.table
    motion, stop = table.in_role("joint targets"), table.in_role("stop")
    numbers = motion.request[0].fields[row_index(motion.request[0])].cases[0].numbers
    target = [each.minimum / 2 / each.divide for each in numbers]
    address = (1,) if table.addresses else ()
    with pytest.raises(MotionTimeout) if errors == "raise" else nullcontext():
        found.sync_send_angles(*address, target, 1, timeout=0.3)
    assert (received.count(motion.name), received.count(stop.name)) == (1, 1)


class Illegal:
    """A robot that replies 7 to the query for the end of a motion, and to no other request."""

    wait = None

    def __init__(self, arm: SimulatedArm) -> None:
        self._arm, self._table = arm.connect(), arm.table

    def receive(self, data: bytes) -> bytes:
        query, has_sum = self._table.in_role("reached").id, bool(self._table.addresses)
        no, illegal = (bytes((query, n, query + n if has_sum else 0xFA)) for n in (0, 7))
        return self._arm.receive(data).replace(no, illegal)

    def flush(self) -> bytes:
        return self._arm.flush()


@pytest.mark.parametrize("errors", ["raise", "return"])
@pytest.mark.parametrize("name", ["MyCobot280", "MyCobot280Socket", "MyPalletizer260", "MyBuddy"])
def test_illegal_reply_during_a_motion_is_a_late_motion(name: str, errors: Any) -> None:
    found, arm = made(name, errors=errors, peer=Illegal)
    address = (1,) if arm.table.addresses else ()
    with pytest.raises(ProtocolError) if errors == "raise" else nullcontext():
        result = found.sync_send_angles(*address, [20] * arm.table.joints, 1, timeout=5)
        assert result == getattr(found, "LATE", found)


def test_closed_arm_opens_again() -> None:
    found, _ = made("MyCobot280")
    found.close()
    found._open_arm.args[0].reopen()
    found.open()
    assert found.get_angles() == [0.0] * 6


def test_debug_logs_frames(caplog: pytest.LogCaptureFixture) -> None:
    logger = logging.getLogger("cobotwire.traffic")
    try:
        made("MyCobot280", debug=True)[0].get_angles()
        assert "fe fe 02 20 fa" in caplog.text.lower()
    finally:
        logger.setLevel(logging.NOTSET)


def test_unknown_policy_is_named() -> None:
    with pytest.raises(UsageError, match="errors is 'ignore'"):
        made("MyCobot280", errors="ignore")
