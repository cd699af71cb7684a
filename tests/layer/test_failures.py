"""What a call of the layer does when the robot does not answer."""

from __future__ import annotations

import logging
from contextlib import nullcontext
from functools import partial
from typing import Any

import pytest

import cobotwire.pymycobot as layer
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import MotionTimeout, ReplyTimeout, UsageError
from cobotwire.protocol.roles import row_index
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock


def made(errors: Any, arm: SimulatedArm, clock: SteppedClock, debug: bool = False) -> Any:
    found = object.__new__(layer.MyCobot280)
    transport = MemoryTransport(arm, clock)
    found._open(partial(layer.MyCobot280.NATIVE, transport), debug, errors)
    return found


@pytest.fixture
def clock() -> SteppedClock:
    return SteppedClock()


@pytest.fixture
def arm(clock: SteppedClock) -> SimulatedArm:
    return SimulatedArm(TABLE, clock=clock, acks=False)


def test_order_without_acknowledgement_raises_or_returns_minus_one(
    arm: SimulatedArm, clock: SteppedClock
) -> None:
    with pytest.raises(ReplyTimeout):
        made("raise", arm, clock).set_color(1, 2, 3)
    with pytest.raises(ReplyTimeout):
        made(None, arm, clock).set_color(1, 2, 3)
    assert made("return", arm, clock).set_color(1, 2, 3) == -1
    assert arm.state.colour == (1, 2, 3)


def test_query_without_reply_raises_or_returns_minus_one(
    arm: SimulatedArm, clock: SteppedClock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(type(arm.connect()), "receive", lambda self, data: b"")
    with pytest.raises(ReplyTimeout):
        made("raise", arm, clock).get_angles()
    assert made("return", arm, clock).get_angles() == -1


def test_quiet_order_waits_for_nothing(arm: SimulatedArm, clock: SteppedClock) -> None:
    before = clock()
    assert made("raise", arm, clock).send_angles([0] * 6, 50, _async=True) is None
    assert clock() - before < 0.1


def test_wrong_argument_raises_in_both_cases(arm: SimulatedArm, clock: SteppedClock) -> None:
    for errors in ("raise", "return"):
        with pytest.raises(UsageError):
            made(errors, arm, clock).send_angle(9, 0, 50)


def test_motion_that_does_not_arrive_raises_or_returns_one_as_the_library(
    clock: SteppedClock,
) -> None:
    unpowered = SimulatedArm(TABLE, clock=clock)
    with pytest.raises(MotionTimeout):
        made("raise", unpowered, clock).sync_send_angles([20] * 6, 50, timeout=1)
    assert made("return", unpowered, clock).sync_send_angles([20] * 6, 50, timeout=1) == 1


SYNC = [name for name in layer.__all__ if hasattr(getattr(layer, name), "sync_send_angles")]


class Counting(MemoryTransport):
    """A line to a simulated arm that keeps the ids of what is written."""

    def __init__(self, arm: SimulatedArm, clock: SteppedClock) -> None:
        super().__init__(arm, clock)
        self.sent: list[int] = []
        self._at = 4 if arm.table.addresses else 3

    def write(self, data: bytes) -> None:
        self.sent.append(data[self._at])
        super().write(data)


@pytest.mark.parametrize("errors", ["raise", "return"])
@pytest.mark.parametrize("name", SYNC)
def test_motion_that_is_late_is_stopped_once_whatever_errors_do(
    name: str, errors: Any, clock: SteppedClock
) -> None:
    kind = getattr(layer, name)
    table = kind.NATIVE.table
    motion, stop = table.in_role("joint targets"), table.in_role("stop")
    numbers = motion.request[0].fields[row_index(motion.request[0])].cases[0].numbers
    target = [each.minimum / 2 / each.divide for each in numbers]
    address = (1,) if table.addresses else ()
    transport = Counting(SimulatedArm(table, clock=clock, powered=True), clock)
    found = object.__new__(kind)
    found._open(partial(kind.NATIVE, transport), False, errors)
    with pytest.raises(MotionTimeout) if errors == "raise" else nullcontext():
        found.sync_send_angles(*address, target, 1, timeout=0.3)
    assert (transport.sent.count(motion.id), transport.sent.count(stop.id)) == (1, 1)


def test_closed_arm_opens_again(arm: SimulatedArm, clock: SteppedClock) -> None:
    found = made("raise", arm, clock)
    found.close()
    found._open_arm.args[0].reopen()
    found.open()
    assert found.get_angles() == [0.0] * 6


def test_debug_logs_frames(
    arm: SimulatedArm, clock: SteppedClock, caplog: pytest.LogCaptureFixture
) -> None:
    logger = logging.getLogger("cobotwire.traffic")
    try:
        made("raise", arm, clock, debug=True).get_angles()
        assert "fe fe 02 20 fa" in caplog.text.lower()
    finally:
        logger.setLevel(logging.NOTSET)


def test_unknown_policy_is_named(arm: SimulatedArm, clock: SteppedClock) -> None:
    with pytest.raises(UsageError, match="errors is 'ignore'"):
        made("ignore", arm, clock)
