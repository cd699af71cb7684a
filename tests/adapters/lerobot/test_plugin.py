"""Test robot and teleoperator with a stand-in for LeRobot; `make lerobot` runs the real one."""

from __future__ import annotations

import math
import time
from contextlib import suppress
from typing import Any

import pytest
from lerobot.robots import Robot
from lerobot.teleoperators import Teleoperator

import lerobot_robot_cobotwire as plugin
from cobotwire import UsageError, editions
from cobotwire.protocol.errors import ArmNotReady
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from lerobot_robot_cobotwire.interface import DeviceAlreadyConnectedError, DeviceNotConnectedError

JOINTS = [f"joint{number}.pos" for number in range(1, 7)]
POSE = dict(zip(JOINTS, [10.0, -20.0, 30.0, -40.0, 50.0, -60.0]))
DOWN = dict.fromkeys(JOINTS, 0.0) | {"joint2.pos": 130.0}


class Bench:
    """A simulated arm in stepped time, and the robot or teleoperator on it."""

    def __init__(self, edition: str = "mycobot280", *, powered: bool = True) -> None:
        self.clock, table = SteppedClock(), editions.load(edition).TABLE
        self.arm = SimulatedArm(table, clock=self.clock, powered=powered)
        self.names = {command.id: command.name for command in reversed(table.commands)}
        self.edition, self.requests = edition, list[str]()

    def connect(self, kind: str = "Robot", **options: Any) -> Any:
        """Return a connected device; record its requests except queries."""
        port: Any = MemoryTransport(self.arm.connect(), self.clock)
        config = getattr(plugin, f"Cobotwire{kind}Config")
        device = getattr(plugin, f"Cobotwire{kind}")(
            config(edition=self.edition, port=port, **options)
        )
        device.connect()
        device.arm.add_traffic_listener(self._note)
        return device

    def _note(self, traffic: Any) -> None:
        if traffic.direction == "sent" and "get" not in (name := self.names[traffic.data[3]]):
            self.requests.append(name)


def test_classes_have_what_lerobot_requires() -> None:
    for ours, base in (
        (plugin.CobotwireRobot, Robot),
        (plugin.CobotwireTeleoperator, Teleoperator),
    ):
        assert [name for name in base.required.split() if not hasattr(ours, name)] == []


@pytest.mark.parametrize("edition", editions.names())
def test_each_edition_has_a_teleoperator_and_if_it_has_motors_a_robot(edition: str) -> None:
    table = editions.load(edition).TABLE
    place: dict[str, Any] = {"edition": edition, "port": "nowhere"}
    if table.addresses:
        with pytest.raises(UsageError, match="address is None; allowed: LEFT, RIGHT"):
            plugin.CobotwireRobot(plugin.CobotwireRobotConfig(**place))
        place["address"] = "LEFT"
    led = plugin.CobotwireTeleoperator(plugin.CobotwireTeleoperatorConfig(**place))
    assert [*led.action_features] == [f"joint{n}.pos" for n in range(1, table.joints + 1)]
    config = plugin.CobotwireRobotConfig(**place)
    if edition == "myarm_c650":
        with pytest.raises(UsageError, match="has no motors: use it as a teleoperator"):
            plugin.CobotwireRobot(config)
    else:
        robot = plugin.CobotwireRobot(config)
        assert robot.action_features == robot.observation_features == led.action_features


def test_targets_are_clipped_and_the_newest_replaces_those_before_it() -> None:
    bench = Bench()
    robot = bench.connect(joint_limits=[(-5.0, 5.0), *[None] * 5], silence=3000.0)
    robot.send_action(dict.fromkeys(JOINTS, -1000.0))
    sent = robot.send_action(POSE)
    assert sent == POSE | {"joint1.pos": 5.0}
    assert bench.requests == ["send_angles"] * 2, "send_action() does not wait"
    bench.clock.sleep(5.0)
    assert robot.get_observation() == pytest.approx(sent, abs=0.1)
    for wrong in ({}, POSE | {"joint7.pos": 0.0}, POSE | {"joint3.pos": math.nan}):
        with pytest.raises(UsageError, match=r"allowed: (joint1\.pos|a finite number)"):
            robot.send_action(wrong)
    assert len(bench.requests) == 2
    without_limits = Bench("pro400").connect()
    with pytest.raises(UsageError, match="angles"):
        without_limits.send_action(dict.fromkeys(JOINTS, 1e6))


def test_joints_stay_inside_the_workspace_and_the_gripper_moves_when_its_target_changes(
    caplog: pytest.LogCaptureFixture,
) -> None:
    bench = Bench()
    robot = bench.connect(workspace=[None, None, (100.0, 500.0)], gripper=True)
    assert robot.send_action(DOWN | {"gripper.pos": 130.0})["joint2.pos"] == 0.0
    inside = robot.send_action(POSE | {"gripper.pos": 99.9})
    for _ in range(3):
        assert robot.send_action(DOWN | {"gripper.pos": 40.0}) == inside | {"gripper.pos": 40.0}
    assert bench.requests == ["set_gripper_value", "send_angles", "set_gripper_value"]
    assert "would move the end of the arm to z -11.3 mm" in caplog.records[1].message
    assert len(caplog.records) == 2
    assert {type(value) for value in robot.get_observation().values()} == {float}


@pytest.mark.parametrize(
    ("option", "text"),
    [
        ({"workspace": [None, None, None]}, "states no geometry"),
        ({"gripper": True}, "cannot move a gripper: use gripper=false"),
        ({"max_speed": 140}, "limits.speed is 140"),
        ({"silence": 0.0}, r"silence is 0\.0"),
    ],
)
def test_wrong_option_is_refused_before_the_port_is_opened(option: Any, text: str) -> None:
    with pytest.raises(UsageError, match=text):
        plugin.CobotwireRobot(
            plugin.CobotwireRobotConfig(edition="myarm_m750", port="nowhere", **option)
        )


@pytest.mark.parametrize("end", ["return", "error", "handled error"])
@pytest.mark.parametrize("on_error", ["stop", "leave"])
def test_disconnect_stops_the_arm_once_however_the_program_ends(on_error: str, end: str) -> None:
    bench = Bench()
    robot = bench.connect(on_error=on_error, silence=3000.0)
    robot.send_action(POSE)
    with suppress(KeyboardInterrupt):
        try:
            if end != "return":
                raise KeyboardInterrupt
        except KeyboardInterrupt:
            # lerobot-teleoperate handles Ctrl-C before it disconnects the arm.
            if end == "error":
                raise
        finally:
            robot.disconnect()
    assert bench.requests[1:] == (["stop"] if on_error == "stop" else [])
    with pytest.raises(DeviceNotConnectedError, match="not connected: call connect"):
        robot.send_action(POSE)


def test_disconnect_sends_nothing_if_no_action_was_sent_since_connect() -> None:
    bench = Bench()
    robot = bench.connect(silence=3000.0)
    robot.get_observation()
    robot.disconnect()
    assert bench.requests == []


def test_arm_is_stopped_when_no_action_comes() -> None:
    bench = Bench()
    robot = bench.connect(silence=0.5, max_speed=10)
    for _ in range(3):
        robot.send_action(POSE)
        bench.clock.sleep(0.3)
        time.sleep(0.05)
    assert "stop" not in bench.requests
    bench.clock.sleep(0.3)
    ends = time.monotonic() + 5.0
    while bench.requests[-1] != "stop" and time.monotonic() < ends:
        time.sleep(0.01)
    bench.clock.sleep(5.0)
    assert robot.get_observation()["joint6.pos"] > -50.0


@pytest.mark.simulated_arm(transport="tcp")
def test_arm_without_power_is_not_connected(simulated_arm_url: str) -> None:
    config = plugin.CobotwireRobotConfig(edition="mycobot280", port=simulated_arm_url)
    with pytest.raises(ArmNotReady, match=f"cobotwire call {simulated_arm_url} power_on"):
        plugin.CobotwireRobot(config).connect()


@pytest.mark.parametrize(("edition", "released"), [("mycobot280", True), ("myarm_c650", False)])
def test_arm_that_a_person_moves_is_read(edition: str, released: bool) -> None:
    bench = Bench(edition, powered=released)
    led = bench.connect("Teleoperator", released=released)
    bench.arm.lead([(1.0, (10.0,) * bench.arm.state.joints)])
    with pytest.raises(DeviceAlreadyConnectedError):
        led.connect()
    bench.clock.sleep(2.0)
    assert led.get_action() == pytest.approx(dict.fromkeys(led.action_features, 10.0), abs=0.1)
    if not released:
        with pytest.raises(UsageError, match="has no command that releases all motors"):
            bench.connect("Teleoperator", released=True)
