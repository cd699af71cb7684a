"""pymycobot's class MyCobot, unmodified, drives the simulated arm of edition mycobot over a pty.

In this edition the arm does not acknowledge setters. pymycobot waits for a reply all the same. So
it sends each setter three times, takes 1.5 s and returns -1, although the arm obeys.
"""

from __future__ import annotations

import math
import time

import pytest

from pymycobot_classes import MyCobot
from pymycobot_rig import READ_BACK, Rig, on_ticks, rig_fixtures

UNANSWERED = -1


opened, rig = rig_fixtures(MyCobot, connection="connection")


def test_setter_is_sent_three_times_in_one_and_a_half_seconds(rig: Rig) -> None:
    started = time.monotonic()
    assert rig.peer.set_color(255, 128, 1) == UNANSWERED
    assert 1.4 < time.monotonic() - started < 3
    assert rig.received == ["set_color"] * 3
    assert rig.state.colour == (255, 128, 1)


def test_query_with_a_reply_is_sent_once(rig: Rig) -> None:
    assert rig.peer.get_angles() == [0.0] * 6
    assert rig.received == ["get_angles"]


def test_step_of_ten_degrees_moves_the_arm_thirty(rig: Rig) -> None:
    # This is why cobotwire never sends a motion twice.
    rig.peer.jog_increment(1, 10, 100)
    assert rig.received == ["jog_increment"] * 3
    rig.advance(60)
    assert rig.angles == pytest.approx((30.0, 0, 0, 0, 0, 0), abs=0.1)


def test_power_on_and_off_read_back(rig: Rig) -> None:
    rig.arm.state = rig.arm.new_state()
    peer = rig.peer
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [0, 0, 0]
    assert peer.power_on() == UNANSWERED
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [1, 1, 1]
    assert rig.state.powered
    assert peer.is_controller_connected() == 1
    assert peer.power_off() == UNANSWERED
    assert peer.is_power_on() == 0
    assert not rig.state.powered


def test_release_all_servos_disables_every_servo(rig: Rig) -> None:
    assert rig.peer.release_all_servos() == UNANSWERED
    assert rig.peer.is_all_servo_enable() == 0
    assert rig.state.enabled == [False] * 6


def test_angles_that_were_sent_read_back(rig: Rig) -> None:
    # -2.58 degrees are FE FE on the wire, 2.5 degrees 00 FA: header and footer inside the data.
    target = [10.5, -20.25, 30.0, -2.58, 2.5, -160.0]
    assert rig.peer.send_angles(target, 100) == UNANSWERED
    rig.advance(60)
    assert rig.angles == on_ticks(*target)
    assert rig.peer.get_angles() == pytest.approx(target, abs=READ_BACK)
    radians = [math.radians(angle) for angle in target]
    assert rig.peer.get_radians() == pytest.approx(radians, abs=0.002)


def test_angle_of_one_joint_reads_back_on_the_way(rig: Rig) -> None:
    assert rig.peer.send_angle(3, -75, 50) == UNANSWERED
    rig.advance(0.6875)
    assert rig.peer.is_moving() == 1
    # 75 degrees a second take 0.375 s to reach: half of the way is done after 0.6875 s.
    assert rig.peer.get_angles() == pytest.approx([0, 0, -37.5, 0, 0, 0], abs=READ_BACK)
    assert rig.peer.is_in_position([0, 0, -75, 0, 0, 0], 0) == 0
    rig.advance(1)
    assert rig.peer.is_moving() == 0
    assert rig.peer.is_in_position([0, 0, -75, 0, 0, 0], 0) == 1
    assert rig.angles[2:3] == on_ticks(-75.0)


def test_coordinates_that_were_sent_read_back(rig: Rig) -> None:
    rig.bend()
    before = rig.peer.get_coords()
    assert before == list(rig.pose)
    target = [before[0] - 10, before[1] + 25.5, before[2] - 30, *before[3:]]
    assert rig.peer.send_coords(target, 100, 1) == UNANSWERED
    rig.advance(60)
    assert rig.peer.get_coords() == pytest.approx(target, abs=0.8)
    assert rig.peer.is_in_position(target, 1) == 1


@pytest.mark.parametrize(("axis", "value"), [(2, -33.3), (6, -77.5)])
def test_one_coordinate_that_was_sent_moves_the_end(rig: Rig, axis: int, value: float) -> None:
    rig.bend()
    expected = list(rig.pose)
    assert rig.peer.send_coord(axis, value, 100) == UNANSWERED
    rig.advance(60)
    expected[axis - 1] = value
    assert rig.peer.get_coords() == pytest.approx(expected, abs=0.8)


def test_pause_resume_and_stop_act_on_a_motion(rig: Rig) -> None:
    peer = rig.peer
    rig.state.angles.go((100.0, 0, 0, 0, 0, 0), 10.0, rig.now)
    rig.advance(1)
    assert peer.pause() == UNANSWERED
    rig.advance(5)
    assert [peer.is_paused(), peer.is_moving(), rig.angles[:1]] == [1, 0, on_ticks(10.0)]
    assert peer.resume() == UNANSWERED
    rig.advance(1)
    assert [peer.is_paused(), peer.is_moving(), rig.angles[:1]] == [0, 1, on_ticks(19.75)]
    assert peer.stop() == UNANSWERED
    rig.advance(5)
    assert [peer.is_moving(), rig.angles[:1]] == [0, on_ticks(20.0)]
    assert peer.send_angle(1, 30, 100) == UNANSWERED
    rig.advance(5)
    assert rig.angles[:1] == on_ticks(30.0)


def test_jog_moves_a_joint_and_a_coordinate(rig: Rig) -> None:
    # The jog is sent three times, which does not change its speed.
    assert rig.peer.jog_angle(2, 0, 10) == UNANSWERED
    rig.advance(1)
    assert rig.angles == on_ticks(0.0, -15.0 + 0.5625, 0.0, 0.0, 0.0, 0.0)
    rig.bend()
    x, y, height = rig.pose[:3]
    assert rig.peer.jog_coord(3, 1, 10) == UNANSWERED
    rig.advance(1)
    assert rig.pose[:2] == pytest.approx((x, y), abs=0.8)
    assert rig.pose[2] > height + 10


def test_encoders_that_were_sent_read_back(rig: Rig) -> None:
    assert rig.peer.get_encoders() == [2048] * 6
    assert rig.peer.set_encoders([1024, 2048, 2560, 2048, 2048, 2049], 100) == UNANSWERED
    rig.advance(60)
    assert rig.peer.get_encoders() == [1024, 2048, 2560, 2048, 2048, 2049]
    assert rig.peer.get_encoder(1) == 1024
    assert rig.angles[:3] == (90.0, 0.0, 45.0), "these angles are exact ticks"


def test_set_encoder_of_pymycobot_is_rejected_because_it_carries_a_speed(rig: Rig) -> None:
    assert rig.peer.set_encoder(1, 1024, 50) == UNANSWERED
    assert rig.received == []
    assert b"".join(rig.rejected) == bytes.fromhex("FE FE 06 3A 01 04 00 32 FA") * 3
    rig.advance(60)
    assert rig.angles == (0.0,) * 6


def test_gripper_value_and_state_move_the_gripper(rig: Rig) -> None:
    assert rig.peer.set_gripper_value(60, 100) == UNANSWERED
    rig.advance(60)
    assert rig.state.gripper.position(rig.now) == (60.0,)
    assert rig.peer.set_gripper_state(1, 100) == UNANSWERED
    rig.advance(60)
    assert rig.state.gripper.position(rig.now) == (0.0,)


def test_pins_that_were_set_read_back(rig: Rig) -> None:
    assert [rig.peer.get_digital_input(23), rig.peer.get_basic_input(5)] == [0, 0]
    assert rig.peer.set_digital_output(23, 1) == UNANSWERED
    assert rig.peer.set_basic_output(5, 1) == UNANSWERED
    assert [rig.peer.get_digital_input(23), rig.peer.get_basic_input(5)] == [1, 1]
    assert (rig.state.pins, rig.state.basic_pins) == ({23: True}, {5: True})


def test_servo_register_that_was_written_reads_back(rig: Rig) -> None:
    assert rig.peer.get_servo_data(2, 21) == 10
    assert rig.peer.set_servo_data(2, 21, 25) == UNANSWERED
    assert rig.peer.get_servo_data(2, 21) == 25
    assert [registers[21] for registers in rig.state.registers[:6]] == [10, 25, 10, 10, 10, 10]


def test_joint_limits_read_as_unconverted_tenths(rig: Rig) -> None:
    # MyCobot280 and MyPalletizer260 divide by ten; this class does not.
    rig.state.minimum[2], rig.state.maximum[2] = -150.5, 150.5
    assert rig.peer.get_joint_min_angle(3) == -1505
    assert rig.peer.get_joint_max_angle(3) == 1505


def test_account_reads_back_and_port_is_set(rig: Rig) -> None:
    assert rig.peer.get_ssid_pwd() == ("MyCobotWiFi2.4G", "mycobot123")
    assert rig.peer.set_server_port(9100) == UNANSWERED
    assert rig.state.port == 9100
