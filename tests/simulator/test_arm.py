"""Test the simulated arm in memory, with a clock that the test steps."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import editions
from cobotwire.editions.mycobot import TABLE, TargetKind
from cobotwire.protocol.effects import Code, effect_of
from cobotwire.simulator.behaviour import own
from simulator.bench import Bench


@pytest.fixture
def bench() -> Bench:
    return Bench(TABLE)


# Commands with a stated effect, to which code adds what the language cannot say: the size of a
# reply, the group of an error, a motion without known lengths, an unknown frame, and two ways to
# state a speed.
REFINED = {
    *("get_servo_data", "get_error_information", "set_solution_angles"),
    *("get_base_coords", "is_in_position_base_coords", "is_waist_in_position", "set_encoders"),
}


@pytest.mark.parametrize("name", editions.names())
def test_exactly_the_commands_whose_effect_is_code_have_a_behaviour(name: str) -> None:
    table = editions.load(name).TABLE
    said_by_code = {c.name for c in table.commands if isinstance(effect_of(c), Code)}
    with_behaviour = {c.name for c in table.commands if own(table, c) is not None}
    assert said_by_code <= with_behaviour <= said_by_code | REFINED
    assert [c.name for c in table.commands if effect_of(c) is None and not c.event] == []


# The tolerance of a reported angle: a tick, and the truncation to hundredths.
TOLERANCE = 0.098


def near(*angles: float) -> Any:
    return pytest.approx(angles, abs=TOLERANCE)


def test_joints_move_over_time_and_stop_together(bench: Bench) -> None:
    target = (60.0, -30.0, 0.0, 15.0, 0.0, 0.0)
    bench.send("send_angles", target, 20)
    assert bench.query("is_moving") == 1
    # 20 % of speed is 30 degrees a second for the joint with the longest way; at 200 degrees per
    # second squared, accelerating and braking take 0.15 s each.
    bench.clock.sleep(0.075 + 1.0)
    assert bench.query("get_angles") == near(30.0, -15.0, 0.0, 7.5, 0.0, 0.0)
    bench.clock.sleep(1.0)
    assert bench.query("is_moving") == 1
    bench.clock.sleep(0.08)
    assert bench.query("get_angles") == near(*target)
    assert bench.query("is_moving") == 0
    assert bench.query("is_in_position", target, TargetKind.ANGLES) == 1
    assert bench.query("is_in_position", (60.2, -30.0, 0, 15.0, 0, 0), TargetKind.ANGLES) == 0


def test_target_sent_during_a_pause_starts_with_resume(bench: Bench) -> None:
    bench.send("pause")
    bench.send("send_angle", 1, 30.0, 20)
    bench.clock.sleep(3.0)
    assert bench.query("get_angles")[0] == 0.0
    bench.send("resume")
    bench.clock.sleep(0.575)
    assert bench.query("get_angles")[:1] == near(15.0)


def test_arm_without_power_or_torque_does_not_move() -> None:
    bench = Bench(TABLE, powered=False)
    bench.send("send_angle", 1, 30.0, 100)
    assert bench.query("is_moving") == 0
    bench.send("power_on")
    bench.send("release_servo", 3)
    bench.send("send_angle", 1, 30.0, 100)
    assert bench.query("is_moving") == 0
    assert bench.query("is_all_servo_enable") == 0
    assert bench.query("is_servo_enable", 3) == 0
    bench.send("focus_servo", 3)
    bench.send("set_free_mode", True)
    bench.send("send_angle", 1, 30.0, 100)
    assert bench.query("is_moving") == 0


def test_new_limit_ends_a_motion_that_leads_beyond_it_before_the_last_target(bench: Bench) -> None:
    bench.send("send_angle", 3, -60.0, 20)
    bench.send("send_angle", 3, 40.0, 20)
    bench.clock.sleep(0.4)
    bench.send("set_joint_min", 3, 0.0)
    bench.clock.sleep(1.0)
    assert bench.query("is_moving") == 0
    assert -15.0 < bench.query("get_angles")[2] < -8.0


def test_jog_continues_until_it_is_stopped(bench: Bench) -> None:
    bench.send("jog_angle", 1, 0, 20)
    bench.clock.sleep(1.0)
    bench.send("jog_stop")
    bench.clock.sleep(1.0)
    assert bench.query("get_angles")[:1] == near(-30.0)
    bench.send("jog_angle", 1, 0, 100)
    bench.clock.sleep(60.0)
    # The outermost tick inside -165 degrees.
    assert bench.query("get_angles")[0] == -164.97
    bench.send("jog_angle", 1, 0, 100)
    assert "limit" in bench.arm.notes[-1].text


def test_encoders_and_angles_agree(bench: Bench) -> None:
    assert bench.query("get_encoders") == (2048,) * 6
    bench.send("set_encoders", (1024, 3072, 3072, 2048, 2048, 2048), 100)
    bench.clock.sleep(5.0)
    # Signs of the joints: -1 -1 +1 -1 -1 -1; 1024 ticks are 90 degrees.
    assert bench.query("get_angles") == (90.0, -90.0, 90.0, 0.0, 0.0, 0.0)
    assert bench.query("get_encoder", 2) == 3072


def test_calibration_takes_the_present_position_as_zero(bench: Bench) -> None:
    bench.send("send_angle", 4, 30.0, 100)
    bench.clock.sleep(5.0)
    bench.send("set_servo_calibration", 4)
    assert bench.query("get_angles")[3] == 0.0
    assert bench.query("get_encoder", 4) == 2048


def test_incomplete_request_is_given_up_when_the_line_is_idle(bench: Bench) -> None:
    assert bench.arm.receive(bytes.fromhex("FE FE 0F 22 00")) == b""
    assert bench.arm.pending == 5
    assert bench.arm.flush() == b""
    assert bench.arm.pending == 0
    assert bench.query("is_power_on") == 1


def test_gripper_does_not_move_without_power(bench: Bench) -> None:
    bench.send("set_gripper_value", 60, 10)
    bench.clock.sleep(2.0)
    bench.send("power_off")
    bench.clock.sleep(9.0)
    assert bench.query("is_gripper_moving") == 0
    assert bench.query("get_gripper_value") == 30, "it stays where it was when the power went off"
    bench.send("set_gripper_state", 0, 100)
    assert bench.query("is_gripper_moving") == 0
    bench.send("power_on")
    bench.send("set_gripper_state", 0, 100)
    assert bench.query("is_gripper_moving") == 1


def test_in_position_has_a_tolerance_for_millimetres_and_one_for_degrees(bench: Bench) -> None:
    # The tolerance of 0.1 degrees, and half a tick for each of six joints.
    there = list(bench.query("get_coords"))
    for index, off, reached in [(0, 4.8, 1), (2, 5.2, 0), (3, 0.3, 1), (5, 0.5, 0), (5, 4.0, 0)]:
        target = [*there]
        target[index] += off
        assert bench.query("is_in_position", target, TargetKind.COORDS) == reached
