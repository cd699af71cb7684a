"""Wait for motions of the simulated arm: reached, too slow, stuck, or interrupted."""

from __future__ import annotations

import _thread
import asyncio
import signal
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest

from both_ways import Opener, openers
from cobotwire import MotionTimeout, ProtocolError, ReplyTimeout, UsageError
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280, TargetKind
from cobotwire.session import Traffic
from cobotwire.session.motion import Listen, Outcome, Query, goal_of, until_reached
from cobotwire.simulator import PtyServer, SimulatedArm

STOP = bytes.fromhex("FE FE 02 29 FA")
THERE = [10.0, -20.0, 30.0, 0.0, 0.29, -5.0]
OPENERS = openers(MyCobot280, AsyncMyCobot280)


@pytest.fixture
def simulated() -> SimulatedArm:
    return SimulatedArm(TABLE)


@pytest.fixture(params=list(OPENERS))
def arm(request: pytest.FixtureRequest, simulated: SimulatedArm) -> Iterator[Any]:
    """Open either client, on an arm that is powered."""
    opening: Opener = OPENERS[request.param]
    with PtyServer(simulated) as server, opening(server.url) as opened:
        opened.power_on(ack_within=1.0)
        yield opened


def test_move_to_coordinates_returns_when_the_arm_reaches_them(arm: Any) -> None:
    arm.move_angles([0, -30, -60, 0, 0, 0], 100)
    target = [150.0, -70.0, 230.0, *arm.get_coords()[3:]]
    arm.move_coords(target, 100)
    # A distance of up to five millimetres counts as reached.
    assert list(arm.get_coords())[:3] == pytest.approx(target[:3], abs=5.0)
    assert arm.is_in_position(target, TargetKind.COORDS) is True


def test_move_that_is_not_waited_for_returns_at_once(arm: Any) -> None:
    arm.move_angles([150, 0, 0, 0, 0, 0], 10, wait=False)
    assert arm.is_moving() is True
    with pytest.raises(MotionTimeout):
        arm.wait_until_reached([150, 0, 0, 0, 0, 0], TargetKind.ANGLES, timeout=0.2)
    arm.send_angles([0, 0, 0, 0, 0, 0], 100, ack_within=1.0)


def test_slow_move_raises_a_timeout_and_is_stopped(arm: Any) -> None:
    started = time.monotonic()
    with pytest.raises(
        MotionTimeout, match=r"has not reached .* it is at .* stop was sent"
    ) as caught:
        arm.move_angles([150, 0, 0, 0, 0, 0], 10, timeout=0.5)
    assert 0.4 < time.monotonic() - started < 1.0
    error = caught.value
    assert isinstance(error, TimeoutError)
    assert error.standing is False
    assert error.stopped is True
    assert error.state.powered is True
    assert error.state.position is not None
    assert 0 < error.state.position[0] < 150
    time.sleep(0.2)  # the arm takes some time to stop
    assert arm.is_moving() is False


def test_arm_that_stops_short_raises_an_error_before_the_timeout(
    arm: Any, simulated: SimulatedArm
) -> None:
    simulated.state.maximum[2] = 10.0  # the arm ignores targets beyond its limits
    started = time.monotonic()
    with pytest.raises(MotionTimeout, match="stands still short of"):
        arm.move_angles(THERE, 50, timeout=20)
    assert time.monotonic() - started < 3


def test_failed_motion_says_what_keeps_the_arm_from_moving(simulated: SimulatedArm) -> None:
    with PtyServer(simulated) as server, MyCobot280(server.url) as arm:
        with pytest.raises(MotionTimeout, match="it has no power") as caught:
            arm.move_angles(THERE, 50, timeout=5)
        assert caught.value.state.powered is False
        arm.power_on(ack_within=1.0)
        arm.pause()
        with pytest.raises(MotionTimeout, match="its motion is paused"):
            arm.move_angles(THERE, 50, timeout=5)
        simulated.state.error = 32
        with pytest.raises(MotionTimeout, match=r"error register is 32: the inverse kin.* has no"):
            arm.wait_until_reached([150, 0, 0, 0, 0, 0], TargetKind.ANGLES, timeout=0.2)
        simulated.state.error = 99
        with pytest.raises(MotionTimeout, match="error register is 99, which no source explains"):
            arm.wait_until_reached([150, 0, 0, 0, 0, 0], TargetKind.ANGLES, timeout=0.2)


def test_target_beyond_the_limits_is_rejected_before_a_byte_is_sent(arm: Any) -> None:
    with pytest.raises(UsageError):
        arm.move_angles([169, 0, 0, 0, 0, 0], 50)
    with pytest.raises(UsageError, match="timeout"):
        arm.move_angles(THERE, 50, timeout=-1)
    assert arm.is_moving() is False


def test_ctrl_c_stops_the_arm(simulated: SimulatedArm) -> None:
    traffic: list[Traffic] = []
    with PtyServer(simulated) as server, MyCobot280(server.url, trace=traffic.append) as arm:
        arm.power_on(ack_within=1.0)
        threading.Timer(0.3, _thread.interrupt_main).start()
        with pytest.raises(KeyboardInterrupt):
            arm.move_angles([150, 0, 0, 0, 0, 0], 10)
        assert [one.data for one in traffic if one.direction == "sent"][-1] == STOP
        time.sleep(0.2)  # the arm takes some time to stop
        assert arm.is_moving() is False


def test_cancelled_move_stops_the_arm(simulated: SimulatedArm) -> None:
    async def drive(url: str) -> bool:
        async with AsyncMyCobot280(url) as arm:
            await arm.power_on(ack_within=1.0)
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0.3):
                    await arm.move_angles([150, 0, 0, 0, 0, 0], 10)
            await asyncio.sleep(0.2)  # the arm takes some time to stop
            return await arm.is_moving()

    with PtyServer(simulated) as server:
        assert asyncio.run(drive(server.url)) is False


def test_firmware_without_acks_delays_no_setter_and_times_out_if_acks_are_required() -> None:
    silent = SimulatedArm(TABLE, acks=False)
    for opening in OPENERS.values():
        with PtyServer(silent) as server, opening(server.url) as arm:
            started = time.monotonic()
            for _ in range(50):
                arm.set_color(1, 2, 3)
            assert time.monotonic() - started < 0.3
            with pytest.raises(ReplyTimeout, match=r"set_color\(red=1, green=2, blue=3\)"):
                arm.set_color(1, 2, 3, ack_within=0.1)


def test_query_of_a_wait_depends_on_when_the_end_is_due() -> None:
    target = [40.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    steps = until_reached(TABLE, goal_of(TABLE, target, 0), limit=9.0, started=100.0)
    is_in_position: Any = TABLE.request_type("is_in_position")
    reached, angles = is_in_position(target, 0), TABLE.request_type("get_angles")()

    def next_step(now: float, result: Any = None) -> tuple[Any, Any]:
        """Return the kind of step and its request, or until when it listens."""
        step = steps.send(Outcome(now, result))
        return type(step), step.request if isinstance(step, Query) else getattr(step, "until", 0)

    assert next(steps) == Query(reached, 9.0)
    assert next_step(100.0, False) == (Query, angles)
    assert next_step(100.0, (0.0,) * 6) == (Listen, 100.05)
    assert next_step(100.05) == (Query, angles)
    # The arm is at 10 degrees, and will reach its target in 0.15 s. Early in a wait the queries
    # are not far apart.
    assert next_step(100.05, (10.0, 0, 0, 0, 0, 0)) == (Listen, pytest.approx(100.1))
    assert next_step(100.1) == (Query, angles)
    assert next_step(100.1, (20.0, 0, 0, 0, 0, 0)) == (Listen, pytest.approx(100.2))
    assert next_step(100.2) == (Query, reached)
    with pytest.raises(StopIteration):
        next_step(100.2, True)


def sent(traffic: list[Traffic]) -> list[bytes]:
    return [one.data for one in traffic if one.direction == "sent"]


@pytest.mark.parametrize("way", OPENERS)
@pytest.mark.parametrize("error", [ValueError("a mistake"), KeyboardInterrupt(), SystemExit(1)])
def test_exception_that_leaves_the_block_stops_a_moving_arm_once(
    simulated: SimulatedArm, way: str, error: BaseException
) -> None:
    traffic: list[Traffic] = []

    def fail(url: str) -> None:
        with OPENERS[way](url, trace=traffic.append) as arm:
            arm.power_on(ack_within=1.0)
            arm.jog_angle(1, 1, 30)
            raise error

    with PtyServer(simulated) as server:
        with pytest.raises(type(error)):
            fail(server.url)
        assert sent(traffic).count(STOP) == 1
        assert sent(traffic)[-1] == STOP
        with MyCobot280(server.url) as arm:
            time.sleep(0.2)  # the arm takes some time to stop
            assert arm.is_moving() is False


def move_too_slowly(opening: Opener, url: str, **options: Any) -> None:
    with opening(url, **options) as arm:
        arm.power_on(ack_within=1.0)
        arm.move_angles([150, 0, 0, 0, 0, 0], 10, timeout=0.3)


@pytest.mark.parametrize("way", OPENERS)
def test_motion_that_timed_out_is_stopped_once(simulated: SimulatedArm, way: str) -> None:
    traffic: list[Traffic] = []
    with PtyServer(simulated) as server, pytest.raises(MotionTimeout):
        move_too_slowly(OPENERS[way], server.url, trace=traffic.append)
    assert sent(traffic).count(STOP) == 1


class WithIllegalReply(SimulatedArm):
    """An arm that replies 7 instead of 0 to ``is_in_position``."""

    def receive(self, data: bytes) -> bytes:
        no, illegal = bytes.fromhex("FE FE 03 2A 00 FA"), bytes.fromhex("FE FE 03 2A 07 FA")
        return super().receive(data).replace(no, illegal)


@pytest.mark.parametrize("way", OPENERS)
@pytest.mark.parametrize("call", ["move_angles", "wait_until_reached"])
def test_illegal_reply_during_a_waited_motion_stops_the_arm(way: str, call: str) -> None:
    traffic: list[Traffic] = []
    target = [150, 0, 0, 0, 0, 0]
    with (
        PtyServer(WithIllegalReply(TABLE, powered=True)) as server,
        OPENERS[way](server.url, trace=traffic.append) as arm,
    ):
        arguments = [target, 10] if call == "move_angles" else [target]
        arm.send_angles(target, 10)
        with pytest.raises(ProtocolError, match="reached is 7"):
            getattr(arm, call)(*arguments)
        assert sent(traffic)[-1] == STOP
        time.sleep(0.2)  # the arm takes some time to stop
        assert arm.is_moving() is False


@pytest.mark.parametrize("error", [SystemExit, ZeroDivisionError])
def test_exception_of_a_signal_handler_stops_the_arm(
    simulated: SimulatedArm, error: type[BaseException]
) -> None:
    def fail(*_: object) -> None:
        raise error

    traffic: list[Traffic] = []
    before = signal.signal(signal.SIGALRM, fail)
    try:
        with PtyServer(simulated) as server, MyCobot280(server.url, trace=traffic.append) as arm:
            arm.power_on(ack_within=1.0)
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            with pytest.raises(error):
                arm.move_angles([150, 0, 0, 0, 0, 0], 10)
            assert sent(traffic)[-1] == STOP
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize("way", OPENERS)
def test_moving_arm_is_not_stopped_with_on_error_leave(simulated: SimulatedArm, way: str) -> None:
    traffic: list[Traffic] = []
    with PtyServer(simulated) as server:
        with pytest.raises(MotionTimeout) as caught:
            move_too_slowly(OPENERS[way], server.url, trace=traffic.append, on_error="leave")
        assert caught.value.stopped is False
        assert STOP not in sent(traffic)
        with MyCobot280(server.url) as arm:
            assert arm.is_moving() is True


@pytest.mark.parametrize("way", OPENERS)
def test_leaving_the_block_without_an_exception_changes_nothing(
    simulated: SimulatedArm, way: str
) -> None:
    traffic: list[Traffic] = []
    with PtyServer(simulated) as server:
        with OPENERS[way](server.url, trace=traffic.append) as arm:
            arm.power_on(ack_within=1.0)
            arm.move_angles([150, 0, 0, 0, 0, 0], 10, wait=False)
        assert STOP not in sent(traffic)
        with MyCobot280(server.url) as arm:
            assert arm.is_moving() is True


def test_unknown_value_of_on_error_is_rejected() -> None:
    with pytest.raises(UsageError, match="on_error is 'halt'; allowed: 'stop' or 'leave'"):
        MyCobot280("loop://", on_error="halt")  # type: ignore[arg-type]
