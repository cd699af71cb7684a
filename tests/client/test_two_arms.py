"""A robot with two arms, each on a port of its own: the Mercury B1 and X1."""

from __future__ import annotations

from typing import Any

import pytest

from both_ways import InLoop
from cobotwire import (
    AsyncMercuryX1,
    AsyncTwoArms,
    LinkError,
    MercuryX1,
    MotionTimeout,
    MyBuddy,
    TwoArms,
)
from cobotwire.editions.mercury_x1 import TABLE
from cobotwire.editions.mybuddy import TABLE as MYBUDDY
from cobotwire.protocol.table import Table
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm, SteppedClock

LEFT, RIGHT = [10.0, -20, 0, -90, 0, 90, 5], [-10.0, 20, 0, -60, 0, 60, -5]
FAR = [150.0, 0, 0, -90, 0, 90, 0]
ASYNC: Any = AsyncTwoArms
OPENERS: dict[str, Any] = {
    "blocking": lambda *ports, **options: TwoArms(MercuryX1, *ports, **options),
    "asyncio": lambda *ports, **options: InLoop(ASYNC, AsyncMercuryX1, *ports, **options),
}


class Arm:
    """A simulated arm in memory that notes the names of the commands it receives."""

    def __init__(self, table: Table = TABLE, clock: SteppedClock | None = None) -> None:
        self.received: list[str] = []
        given: dict[str, Any] = {} if clock is None else {"clock": clock}
        self.simulated = SimulatedArm(table, powered=True, on_event=self._note, **given)
        self.transport = MemoryTransport(self.simulated, clock)

    def _note(self, event: Any, _: bytes) -> None:
        self.received.append(event.message.command.name)

    @property
    def closed(self) -> bool:
        return "closed" in repr(self.transport)

    @property
    def stops(self) -> int:
        return self.received.count("stop")


@pytest.fixture
def arms() -> tuple[Arm, Arm]:
    return Arm(), Arm()


@pytest.fixture(params=list(OPENERS))
def opening(request: pytest.FixtureRequest) -> Any:
    """Return a function that opens both arms; each test runs blocking and with asyncio."""
    return OPENERS[request.param]


def fail(robot: Any, error: BaseException) -> None:
    with robot:
        raise error


def test_arms_on_two_ports_move_apart(opening: Any) -> None:
    left, right = SimulatedArm(TABLE, powered=True), SimulatedArm(TABLE, powered=True)
    with (
        PtyServer(left) as first,
        PtyServer(right) as second,
        opening(first.url, second.url, timeout=5.0) as robot,
    ):
        robot.left.send_angles(LEFT, 100)
        robot.right.move_angles(RIGHT, 100)
        robot.left.wait_until_reached(LEFT)
        assert robot.left.get_angles() == pytest.approx(LEFT, abs=0.1)
        assert robot.right.get_angles() == pytest.approx(RIGHT, abs=0.1)


def test_leaving_the_block_closes_both_ports_and_stops_neither_arm(
    opening: Any, arms: tuple[Arm, Arm]
) -> None:
    left, right = arms
    with opening(left.transport, right.transport) as robot:
        assert robot.left.is_power_on() == robot.right.is_power_on() == 1
        assert (left.closed, right.closed) == (False, False)
    assert (left.closed, right.closed) == (True, True)
    assert left.stops + right.stops == 0


@pytest.mark.parametrize("error", [ValueError("a mistake"), KeyboardInterrupt()])
def test_exception_stops_both_arms_once_and_closes_both_ports(
    opening: Any, arms: tuple[Arm, Arm], error: BaseException
) -> None:
    left, right = arms
    with pytest.raises(type(error)):
        fail(opening(left.transport, right.transport), error)
    assert (left.stops, right.stops) == (1, 1)
    assert (left.closed, right.closed) == (True, True)


def test_arms_keep_moving_after_an_exception_with_on_error_leave(
    opening: Any, arms: tuple[Arm, Arm]
) -> None:
    left, right = arms
    with pytest.raises(ValueError, match="a mistake"):
        fail(opening(left.transport, right.transport, on_error="leave"), ValueError("a mistake"))
    assert left.stops + right.stops == 0


def test_lost_port_of_one_arm_does_not_keep_the_other_from_stopping(
    opening: Any, arms: tuple[Arm, Arm]
) -> None:
    left, right = arms
    robot = opening(left.transport, right.transport)
    left.transport.close()
    with pytest.raises(ValueError, match="a mistake"):
        fail(robot, ValueError("a mistake"))
    assert (right.stops, right.closed) == (1, True)


@pytest.mark.parametrize("side", ["left", "right"])
def test_motion_of_one_arm_that_fails_stops_the_other_arm_too(side: str) -> None:
    clock = SteppedClock()
    left, right = Arm(clock=clock), Arm(clock=clock)
    with (
        pytest.raises(MotionTimeout),
        TwoArms(MercuryX1, left.transport, right.transport) as robot,
    ):
        getattr(robot, side).move_angles(FAR, 1, timeout=0.5)
    assert (left.stops, right.stops) == (1, 1)


def test_motion_of_one_limb_that_fails_stops_the_other_limb_too() -> None:
    clock = SteppedClock()
    buddy = Arm(MYBUDDY, clock)
    robot = MyBuddy(buddy.transport)
    robot.right.jog_angle(1, 1, 30)
    with pytest.raises(MotionTimeout), robot:
        robot.left.move_angles([100, 0, 0, 0, 0, 0], 1, timeout=0.5)
    # Each limb gets a stop, and so does the address of the client itself.
    assert buddy.stops == 3


def test_first_port_is_closed_if_the_second_cannot_be_opened(
    opening: Any, arms: tuple[Arm, Arm]
) -> None:
    left, _ = arms
    with pytest.raises(LinkError):
        opening(left.transport, "/dev/no_such_arm")
    assert left.closed
    assert left.stops == 0


class Stuck(MemoryTransport):
    """A transport that reports an error when it is closed."""

    def close(self) -> None:
        super().close()
        raise OSError("cannot be closed")


def test_other_port_is_closed_if_closing_one_fails(opening: Any, arms: tuple[Arm, Arm]) -> None:
    left, right = arms
    stuck = Stuck(left.simulated)
    with pytest.raises(OSError, match="cannot be closed"):
        opening(stuck, right.transport).close()
    assert right.closed
