"""Test robot and teleoperator over a stand-in for LeRobot; `make lerobot` runs the real one."""

from __future__ import annotations

import math
from typing import Any

import pytest
from lerobot.robots import Robot
from lerobot.teleoperators import Teleoperator

from cobotwire import UsageError, editions
from cobotwire.protocol.errors import ArmNotReady
from cobotwire.session import Traffic
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from lerobot_robot_cobotwire import (
    CobotwireRobot,
    CobotwireRobotConfig,
    CobotwireTeleoperator,
    CobotwireTeleoperatorConfig,
)
from lerobot_robot_cobotwire.interface import DeviceAlreadyConnectedError, DeviceNotConnectedError

JOINTS = [f"joint{number}.pos" for number in range(1, 7)]
POSE = dict(zip(JOINTS, [10.0, -20.0, 30.0, -40.0, 50.0, -60.0]))


class Bench:
    """A simulated arm in stepped time, and the requests to it that are no queries."""

    def __init__(self, edition: str = "mycobot280", *, powered: bool = True) -> None:
        self.clock, self.table = SteppedClock(), editions.load(edition).TABLE
        self.arm = SimulatedArm(self.table, clock=self.clock, powered=powered)
        self.port: Any = MemoryTransport(self.arm.connect(), self.clock)
        self.requests: list[str] = []

    def robot(self, **options: Any) -> CobotwireRobot:
        """Return a robot that is connected, and whose requests are noted."""
        config = CobotwireRobotConfig(edition=self.table.edition, port=self.port, **options)
        robot = CobotwireRobot(config)
        robot.connect()
        robot.arm.add_traffic_listener(self._note)
        return robot

    def teleoperator(self, **options: Any) -> CobotwireTeleoperator:
        config = CobotwireTeleoperatorConfig(edition=self.table.edition, port=self.port, **options)
        teleoperator = CobotwireTeleoperator(config)
        teleoperator.connect()
        return teleoperator

    def _note(self, traffic: Traffic) -> None:
        names = {each.id: each.name for each in reversed(self.table.commands)}
        if traffic.direction == "sent" and not names[traffic.data[3]].startswith(("get", "is")):
            self.requests.append(names[traffic.data[3]])


def test_classes_have_what_lerobot_requires() -> None:
    for ours, theirs in ((CobotwireRobot, Robot), (CobotwireTeleoperator, Teleoperator)):
        assert [name for name in theirs.required if not hasattr(ours, name)] == []


@pytest.mark.parametrize("edition", editions.names())
def test_each_arm_has_a_robot_if_it_has_motors_and_a_teleoperator(edition: str) -> None:
    table = editions.load(edition).TABLE
    place: dict[str, Any] = {"edition": edition, "port": "nowhere"}
    if table.addresses:
        with pytest.raises(UsageError, match="address is None; allowed: LEFT, RIGHT"):
            CobotwireRobot(CobotwireRobotConfig(**place))
        place["address"] = "LEFT"
    teleoperator = CobotwireTeleoperator(CobotwireTeleoperatorConfig(**place))
    assert len(teleoperator.action_features) == table.joints
    assert teleoperator.is_calibrated
    if edition == "myarm_c650":
        with pytest.raises(UsageError, match="has no motors: use it as a teleoperator"):
            CobotwireRobot(CobotwireRobotConfig(**place))
        return
    robot = CobotwireRobot(CobotwireRobotConfig(**place))
    assert robot.action_features == robot.observation_features == teleoperator.action_features
    assert robot.name == f"cobotwire_{edition}"


def test_targets_are_clipped_and_the_newest_replaces_those_before_it() -> None:
    bench = Bench()
    robot = bench.robot(joint_limits=[[-5.0, 5.0], *[None] * 5])
    robot.send_action(dict.fromkeys(JOINTS, -1000.0))
    sent = robot.send_action(POSE)
    assert sent == POSE | {"joint1.pos": 5.0}
    assert bench.requests == ["send_angles"] * 2, "nothing is waited for"
    bench.clock.sleep(5.0)
    assert robot.get_observation() == pytest.approx(sent, abs=0.1)


def test_gripper_moves_when_its_target_changes() -> None:
    bench = Bench()
    robot = bench.robot(gripper=True)
    for opening in (40.2, 39.9, 170.0):
        sent = robot.send_action(POSE | {"gripper.pos": opening})
    assert sent["gripper.pos"] == 100.0
    assert bench.requests.count("set_gripper_value") == 2
    bench.clock.sleep(5.0)
    assert robot.get_observation()["gripper.pos"] == 100.0


@pytest.mark.parametrize(
    ("action", "text"),
    [
        ({}, r"the names of the action is \[\]; allowed: joint1.pos, joint2.pos"),
        (POSE | {"joint7.pos": 0.0}, "allowed: joint1.pos"),
        (POSE | {"joint3.pos": math.nan}, "joint3.pos is nan; allowed: a finite number"),
    ],
    ids=["empty", "a joint too many", "not a number"],
)
def test_wrong_action_is_refused_and_nothing_is_sent(action: dict[str, float], text: str) -> None:
    bench = Bench()
    robot = bench.robot()
    with pytest.raises(UsageError, match=text):
        robot.send_action(action)
    assert bench.requests == []


@pytest.mark.parametrize(("on_error", "stops"), [("stop", 1), ("leave", 0)])
def test_disconnect_stops_the_arm_after_an_error_unless_it_is_to_be_left(
    on_error: str, stops: int
) -> None:
    for error in (None, KeyboardInterrupt()):
        bench = Bench()
        robot = bench.robot(on_error=on_error)
        robot.send_action(POSE)
        try:
            if error is not None:
                raise error
        except KeyboardInterrupt:
            robot.disconnect()
        else:
            robot.disconnect()
        assert bench.requests[1:] == ["stop"] * (stops if error else 0)
        assert not robot.is_connected
        with pytest.raises(DeviceNotConnectedError, match="not connected: call connect"):
            robot.send_action(POSE)


@pytest.mark.simulated_arm(transport="tcp")
def test_arm_without_power_is_not_connected(simulated_arm_url: str) -> None:
    config = CobotwireRobotConfig(edition="mycobot280", port=simulated_arm_url)
    with pytest.raises(ArmNotReady, match="the arm has no power") as caught:
        CobotwireRobot(config).connect()
    assert f"cobotwire call {simulated_arm_url} power_on" in str(caught.value)


def test_released_arm_is_read_while_a_person_moves_it() -> None:
    bench = Bench()
    bench.arm.lead([(1.0, tuple(POSE.values()))])
    held = bench.teleoperator()
    bench.clock.sleep(2.0)
    assert held.get_action() == dict.fromkeys(JOINTS, 0.0)
    held.disconnect()
    bench.port = MemoryTransport(bench.arm.connect(), bench.clock)
    released = bench.teleoperator(released=True)
    with pytest.raises(DeviceAlreadyConnectedError):
        released.connect()
    bench.clock.sleep(2.0)
    assert released.get_action() == pytest.approx(POSE, abs=0.1)


def test_arm_that_is_always_moved_by_hand_needs_no_release() -> None:
    bench = Bench("myarm_c650", powered=False)
    bench.arm.lead([(1.0, (10.0,) * 7)])
    bench.clock.sleep(2.0)
    assert bench.teleoperator().get_action()["joint7.pos"] == pytest.approx(10.0, abs=0.1)
    with pytest.raises(UsageError, match="has no command that releases all motors"):
        bench.teleoperator(released=True)
