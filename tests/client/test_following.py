"""Follow paths and live targets: motion without pauses, every ending, exactly one stop."""

from __future__ import annotations

import asyncio
import importlib
import math
import time
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from typing import Any

import pytest

from cobotwire import FollowFailed, FollowReport, Limits, PathLimits, UsageError, editions
from cobotwire.editions.clients import EDITIONS
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280
from cobotwire.kinematics import coords_of, geometry_of, jerk_limited
from cobotwire.session import Traffic
from cobotwire.simulator import MemoryTransport, SimulatedArm
from smoothness import PATH, Watched, follow, loop, run

STOP = bytes.fromhex("FE FE 02 29 FA")
QUEUE, NEWEST = bytes.fromhex("FE FE 03 16 00 FA"), bytes.fromhex("FE FE 03 16 01 FA")


def frames(traffic: list[Traffic]) -> list[bytes]:
    return [each.data for each in traffic if each.direction == "sent"]


def test_follow_does_not_pause_between_points_unlike_a_loop_of_moves() -> None:
    for speed, lag in ((10, 0.0), (30, 0.0), (60, 0.05)):
        done = run(follow, speed, lag)
        assert done.watched.standstills() == 0
        assert done.share > 0.6, speed
        assert done.watched.positions[-1] == pytest.approx(PATH[-1], abs=0.6)
    assert run(loop, 30).watched.standstills() == len(PATH) - 1


def test_flange_follows_straight_lines_between_coordinates() -> None:
    clock, geometry = Watched(), geometry_of(TABLE)
    assert geometry is not None
    with MyCobot280(clock.transport) as arm:
        arm.move_angles([0, -30, -60, 0, 0, 0], 100)
        x, y, z, *turned = arm.get_coords()
        clock.positions.clear()
        report = arm.follow(
            [[x - 40, y, z, *turned], [x - 40, y + 40, z, *turned]], coords=True, speed=10
        )
    assert report.ended == "end"
    places = [coords_of(geometry, angles) for angles in clock.positions]
    assert places[-1][:3] == pytest.approx((x - 40, y + 40, z), abs=2)
    for place in places:
        assert place[2] == pytest.approx(z, abs=1)
        # The corner is rounded, since the joints lag behind.
        assert min(abs(place[0] - x + 40), abs(place[1] - y)) < 2


def test_coordinates_of_a_tool_and_of_an_unknown_geometry_are_refused() -> None:
    clock = Watched()
    with MyCobot280(clock.transport) as arm:
        arm.set_tool_reference([0, 0, 100, 0, 0, 0])
        arm.set_end_type(1)
        with pytest.raises(UsageError, match="a position 100 mm from its flange"):
            arm.follow([arm.get_coords()], coords=True)
    mercury = importlib.import_module("cobotwire.editions.mercury_a1")
    clock = Watched(mercury.TABLE)
    with (
        mercury.MercuryA1(clock.transport) as arm,
        pytest.raises(UsageError, match="the geometry of this arm is not known"),
    ):
        arm.follow([[0] * 6], coords=True)


@pytest.mark.parametrize("name", EDITIONS)
def test_each_edition_follows_or_says_why_not(name: str) -> None:
    module = importlib.import_module(f"cobotwire.editions.{EDITIONS[name]}")
    if name.startswith("Async") or not hasattr(getattr(module, name), "follow"):
        return
    clock = Watched(module.TABLE)
    with getattr(module, name)(clock.transport) as arm:
        target = [angle + 1 for angle in clock.simulated.state.angles.position(0)]
        if name in ("MyArmM750", "MyPalletizer260", "Pro400", "Pro630"):
            with pytest.raises(UsageError, match="so the arm would queue the targets"):
                arm.follow([target])
        else:
            assert arm.follow([target], speed=100).ended == "end"


def timed_source(values: dict[float, Any], clock: Watched) -> Callable[[], Any]:
    """Return a source of targets that turn joint 1.

    From each time in ``values`` on, the source returns that value instead, or raises it if it is an
    exception type.
    """

    def source() -> Any:
        for since, value in reversed(values.items()):
            if clock() >= since:
                if isinstance(value, type):
                    raise value("mine")
                return value
        return [40 * clock(), 0, 0, 0, 0, 0]

    return source


@pytest.mark.parametrize("on_error", ["stop", "leave"])
@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (ZeroDivisionError, ZeroDivisionError, "mine"),
        (KeyboardInterrupt, KeyboardInterrupt, "mine"),
        (None, FollowFailed, r"no target came for 0.50? s, .* setpoints at 50.0 Hz"),
        ([0, math.nan, 0, 0, 0, 0], UsageError, "target: angles.j2 is nan"),
        ([0, 0], UsageError, r"target: len\(angles\) is 2"),
        ([0, 0, 0, 0, 0, 200], UsageError, "target: angles.j6 is 200"),
        ("left", UsageError, "target is 'left'; allowed: a sequence of numbers"),
    ],
)
def test_source_that_fails_stops_the_arm_once_and_raises_a_clear_error(
    value: Any, error: type[BaseException], text: str, on_error: Any
) -> None:
    clock, traffic = Watched(), list[Traffic]()
    with (
        pytest.raises(error, match=text),
        MyCobot280(clock.transport, trace=traffic.append, on_error=on_error) as arm,
    ):
        arm.follow(timed_source({0.5: value}, clock))
    sent = frames(traffic)
    assert sent.count(STOP) == (on_error == "stop")
    # Nothing moves the arm after stop, and the arm is back in queue mode.
    assert sent[-2:] == [STOP, QUEUE] if on_error == "stop" else sent[-1] == QUEUE
    assert 5 < clock.positions[-1][0] < 25


def test_source_that_ends_brings_the_arm_to_its_last_target_without_a_stop() -> None:
    clock, traffic = Watched(), list[Traffic]()
    with MyCobot280(clock.transport, trace=traffic.append) as arm:
        report = arm.follow(timed_source({1.0: [45, 0, 0, 0, 0, 0], 1.2: StopIteration}, clock))
        assert report.ended == "end"
        assert arm.get_angles() == pytest.approx([45, 0, 0, 0, 0, 0], abs=0.6)
        assert STOP not in frames(traffic)


def test_slow_source_does_not_make_the_arm_stop_at_each_target() -> None:
    clock = Watched()
    last = -1

    def ten_a_second() -> Any:
        nonlocal last
        now = math.floor(clock() * 10)
        if now == last:
            return None
        if now > 30:
            raise StopIteration
        last = now
        return [3.0 * now, 0, 0, 0, 0, 0]

    with MyCobot280(clock.transport) as arm:
        arm.follow(ten_a_second)
    inside = clock.speeds[200:-200]
    assert min(inside) > 0.6 * 30


def test_mode_is_set_only_if_it_has_to_be_and_restored() -> None:
    clock, traffic = Watched(), list[Traffic]()
    with MyCobot280(clock.transport, trace=traffic.append) as arm:
        arm.follow(PATH[:1])
        assert [frame for frame in frames(traffic) if frame[3] == 0x16] == [NEWEST, QUEUE]
        arm.set_fresh_mode(1)
        traffic.clear()
        arm.follow(PATH[:1])
        assert not [frame for frame in frames(traffic) if frame[3] == 0x16]


def test_limits_of_the_client_hold_for_every_setpoint() -> None:
    clock, traffic = Watched(), list[Traffic]()
    limits = Limits(speed=20, workspace=[(-400, 400), (-400, 400), (300, 500)])
    with MyCobot280(clock.transport, limits=limits, trace=traffic.append) as arm:
        with pytest.raises(UsageError, match=r"speed is 50; allowed: .* 1..20 percent"):
            arm.follow(PATH)
        with pytest.raises(UsageError, match=r"path\[0\]: .* the end of the arm to z 82"):
            arm.follow([[0, -90, 0, 0, 0, 0]], speed=20)
        assert not [frame for frame in frames(traffic) if frame[3] == 0x22]
        arm.follow(PATH[:1], speed=20, limits=PathLimits(velocity=15))
    setpoints = [frame for frame in frames(traffic) if frame[3] == 0x22]
    assert max(frame[-2] for frame in setpoints) == 10


def test_missing_library_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(jerk_limited, "import_module", absent)
    with (
        MyCobot280(Watched().transport) as arm,
        pytest.raises(UsageError, match=r"needs ruckig: pip install 'cobotwire\[motion\]'"),
    ):
        arm.follow(PATH)


def test_iterators_are_read_while_the_arm_moves_and_their_end_and_errors_arrive() -> None:
    def targets(error: bool) -> Iterator[Sequence[float]]:
        for step in range(20):
            yield [step / 4, 0, 0, 0, 0, 0]
            time.sleep(0.005)
        if error:
            raise ZeroDivisionError
        yield [6.0, 0, 0, 0, 0, 0]

    simulated = SimulatedArm(TABLE, powered=True)
    with MyCobot280(MemoryTransport(simulated)) as arm:
        report = arm.follow(targets(error=False), speed=100)
        assert report.superseded > 0
        assert arm.get_angles()[0] == pytest.approx(6, abs=0.6)
    with pytest.raises(ZeroDivisionError), MyCobot280(MemoryTransport(simulated)) as arm:
        arm.follow(targets(error=True))
    with (
        pytest.raises(UsageError, match="path is 5"),
        MyCobot280(MemoryTransport(simulated)) as arm,
    ):
        arm.follow(5)  # type: ignore[arg-type]


def test_asyncio_client_follows_paths_and_asynchronous_iterators_and_stops_once_if_cancelled() -> (
    None
):
    traffic: list[Traffic] = []

    async def targets() -> AsyncIterator[Sequence[float]]:
        for step in range(15):
            yield [step / 3, 0, 0, 0, 0, 0]
            await asyncio.sleep(0.01)

    async def drive() -> list[FollowReport]:
        transport = MemoryTransport(SimulatedArm(TABLE, powered=True))
        async with AsyncMyCobot280(transport, trace=traffic.append) as arm:
            reports = [
                await arm.follow([[2, 0, 0, 0, 0, 0], [4, 0, 0, 0, 0, 0]]),
                await arm.follow(targets()),
            ]
            assert STOP not in frames(traffic)
            sent, moving = len(traffic), asyncio.create_task(arm.follow([[90, 0, 0, 0, 0, 0]]))
            # follow() reads the joints and chooses the mode before it moves them.
            while not any(frame[3] == 0x22 for frame in frames(traffic[sent:])):
                await asyncio.sleep(0.01)
            with pytest.raises(UsageError, match="another follow"):
                await arm.follow([[0, 0, 0, 0, 0, 0]])
            moving.cancel()
            with pytest.raises(asyncio.CancelledError):
                await moving
            assert frames(traffic)[-2:] == [STOP, QUEUE]
            assert frames(traffic).count(STOP) == 1
        return reports

    for report in asyncio.run(drive()):
        assert report.ended == "end"
        assert report.sent > 10


@pytest.mark.parametrize(
    ("edition", "command", "arguments"),
    [
        ("mycobot280", "stop", []),
        ("mycobot280", "jog_stop", []),
        ("mycobot280", "clear_queue", []),
        ("mycobot280", "pause", []),
        ("mycobot280", "power_off", []),
        ("mycobot280", "release_all_servos", []),
        ("mycobot280", "joint_brake", [1]),
        ("mercury_a1", "stop", [1]),
        ("mercury_a1", "power_off", []),
        ("pro450", "stop", [1]),
    ],
)
def test_command_that_ends_motions_ends_follow_in_each_of_its_variants(
    edition: str, command: str, arguments: list[int]
) -> None:
    found, traffic = editions.load(edition), list[Traffic]()
    setpoint = found.TABLE.in_role("joint targets").id
    clock = Watched(found.TABLE)
    arm: Any = found.CLIENT(clock.transport, trace=traffic.append)
    first, *others = clock.simulated.state.angles.position(0)

    def targets() -> Sequence[float]:
        if clock() > 5:
            raise StopIteration
        if arm.get_angles()[0] > first + 5:
            getattr(arm, command)(*arguments)
            traffic.clear()
        return [first + 60, *others]

    with arm, pytest.raises(FollowFailed, match="the arm was stopped meanwhile") as caught:
        arm.follow(targets)
    assert caught.value.report.ended == "stopped"
    assert f": {command}() was sent" in str(caught.value)
    assert setpoint not in [frame[3] for frame in frames(traffic)]


def test_stop_of_another_address_ends_follow() -> None:
    found = editions.load("mybuddy")
    clock = Watched(found.TABLE)
    arm: Any = found.CLIENT(clock.transport, address="left")

    def targets() -> Sequence[float]:
        if clock() > 5:
            raise StopIteration
        if arm.get_angles()[0] > 5:
            arm.at("right").stop()
        return [60, 0, 0, 0, 0, 0]

    with arm, pytest.raises(FollowFailed, match=r"the arm was stopped meanwhile: stop\(\)"):
        arm.follow(targets)


def test_commands_of_the_gripper_and_of_settings_do_not_end_follow() -> None:
    found = editions.load("mycobot320")
    arm: Any = found.CLIENT(Watched(found.TABLE).transport)

    def targets() -> Sequence[float]:
        if arm.get_angles()[0] > 5:
            arm.set_pro_gripper_stop(14)
            arm.set_color(1, 2, 3)
            arm.power_on()
            raise StopIteration
        return [10, 0, 0, 0, 0, 0]

    with arm:
        assert arm.follow(targets).ended == "end"


@pytest.mark.parametrize(("argument", "value"), [("limits", Limits(speed=3)), ("rate", 4.9)])
def test_wrong_argument_is_named(argument: str, value: Any) -> None:
    with MyCobot280(Watched().transport) as arm, pytest.raises(UsageError) as caught:
        arm.follow([[1, 0, 0, 0, 0, 0]], **{argument: value})
    assert caught.value.argument == argument
