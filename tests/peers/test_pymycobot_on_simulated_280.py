"""pymycobot's class MyCobot280, unmodified, drives a simulated arm of its own edition over a pty.

In this edition the arm acknowledges setters, so pymycobot sends each once and returns 1 at once. In
the older edition, the same calls send three times, take 1.5 s and return -1.
"""

from __future__ import annotations

import math
import time

import pytest

from cobotwire.editions.mycobot280 import TABLE
from pymycobot_classes import MyCobot280
from pymycobot_rig import READ_BACK, Rig, on_ticks, rig_fixtures

DONE = 1


opened, rig = rig_fixtures(MyCobot280, TABLE, connection="connection")


def test_acknowledged_setter_is_sent_once_and_returns_at_once(rig: Rig) -> None:
    started = time.monotonic()
    assert rig.peer.set_color(255, 128, 1) == DONE
    assert time.monotonic() - started < 0.45, "pymycobot waits 0.5 s if no reply comes"
    assert (rig.received, rig.state.colour) == (["set_color"], (255, 128, 1))


def test_step_of_ten_degrees_moves_the_arm_ten(rig: Rig) -> None:
    assert rig.peer.jog_increment(1, 10, 100) == DONE
    rig.advance(60)
    assert (rig.received, rig.angles[:1]) == (["jog_increment"], on_ticks(10.0))


def test_power_on_and_off_read_back(rig: Rig) -> None:
    rig.arm.state = rig.arm.new_state()
    peer = rig.peer
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [0, 0, 0]
    assert peer.power_on() == DONE
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [1, 1, 1]
    assert peer.is_controller_connected() == 1
    assert peer.power_off() == DONE
    assert (peer.is_power_on(), rig.state.powered) == (0, False)


def test_angles_that_were_sent_read_back(rig: Rig) -> None:
    target = [10.5, -20.25, 30.0, -2.58, 2.5, -160.0]
    assert rig.peer.send_angles(target, 100) == DONE
    rig.advance(60)
    assert rig.angles == on_ticks(*target)
    assert rig.peer.get_angles() == pytest.approx(target, abs=READ_BACK)
    assert rig.peer.is_in_position(target) == 1


def test_radians_that_were_sent_read_back(rig: Rig) -> None:
    target = [0, math.pi / 4, -math.pi / 4, math.pi / 2, -math.pi / 2, 0]
    assert rig.peer.send_radians(target, 100) == DONE
    rig.advance(60)
    assert rig.angles == (0.0, 45.0, -45.0, 90.0, -90.0, 0.0)
    assert rig.peer.get_radians() == [round(radian, 3) for radian in target]


def test_coordinates_that_were_sent_read_back(rig: Rig) -> None:
    rig.bend()
    before = rig.peer.get_coords()
    assert before == list(rig.pose)
    target = [before[0] - 10, before[1] + 25.5, before[2] - 30, *before[3:]]
    assert rig.peer.send_coords(target, 100, 1) == DONE
    rig.advance(60)
    assert rig.peer.get_coords() == pytest.approx(target, abs=0.8)
    assert rig.peer.is_in_position(target, 1) == 1
    assert rig.peer.send_coord(2, target[1] - 12.3, 100) == DONE
    rig.advance(60)
    assert rig.peer.get_coords()[1] == pytest.approx(target[1] - 12.3, abs=0.8)


def test_pause_resume_and_stop_act_on_a_motion(rig: Rig) -> None:
    peer = rig.peer
    rig.state.angles.go((100.0, 0, 0, 0, 0, 0), 10.0, rig.now)
    rig.advance(1)
    assert [peer.pause(), peer.is_paused()] == [DONE, 1]
    rig.advance(1)
    assert peer.is_moving() == 0
    rig.advance(5)
    assert [peer.resume(), peer.is_paused(), peer.is_moving()] == [DONE, 0, 1]
    rig.advance(1)
    assert peer.stop() == DONE
    rig.advance(1)
    assert [peer.is_moving(), rig.angles[:1]] == [0, on_ticks(20.0)]


def test_gripper_value_and_state_move_the_gripper(rig: Rig) -> None:
    assert rig.peer.set_gripper_value(60, 100) == DONE
    rig.advance(60)
    assert [rig.peer.get_gripper_value(), rig.peer.is_gripper_moving()] == [60, 0]
    assert rig.peer.set_gripper_state(1, 100) == DONE
    rig.advance(60)
    assert rig.peer.get_gripper_value() == 0
    assert rig.peer.set_gripper_calibration() == DONE


def test_pins_that_were_set_read_back(rig: Rig) -> None:
    assert [rig.peer.get_digital_input(23), rig.peer.get_basic_input(5)] == [0, 0]
    assert [rig.peer.set_digital_output(23, 1), rig.peer.set_basic_output(5, 1)] == [DONE] * 2
    assert [rig.peer.get_digital_input(23), rig.peer.get_basic_input(5)] == [1, 1]
    assert rig.peer.set_pin_mode(23, 2) == DONE
    assert rig.state.pin_modes == {23: 2}


@pytest.mark.parametrize("which", ["tool", "world"])
def test_reference_arrives_in_the_scale_in_which_it_was_sent(rig: Rig, which: str) -> None:
    reference = [100, 20.5, -30, 45, 0, -90]
    assert getattr(rig.peer, f"set_{which}_reference")(reference) == DONE
    assert getattr(rig.peer, f"get_{which}_reference")() == reference
    assert getattr(rig.state, which) == tuple(reference)


def test_joint_limit_arrives_in_the_scale_in_which_it_was_sent(rig: Rig) -> None:
    assert rig.peer.set_joint_max(1, 90) == DONE
    assert (rig.state.maximum[0], rig.peer.get_joint_max_angle(1)) == (90.0, 90.0)
    assert rig.peer.set_joint_min(1, -45) == DONE
    assert (rig.state.minimum[0], rig.peer.get_joint_min_angle(1)) == (-45.0, -45.0)


def test_reference_frame_end_type_and_refresh_mode_are_set(rig: Rig) -> None:
    peer = rig.peer
    assert [peer.set_reference_frame(1), peer.set_end_type(1), peer.set_fresh_mode(1)] == [DONE] * 3
    assert [peer.get_reference_frame(), peer.get_end_type()] == [1, 1]
    assert rig.state.fresh_mode == 1


def test_encoders_that_were_sent_read_back(rig: Rig) -> None:
    assert rig.peer.set_encoders([1024, 2048, 2560, 2048, 2048, 2049], 100) == DONE
    rig.advance(60)
    assert rig.peer.get_encoders() == [1024, 2048, 2560, 2048, 2048, 2049]
    assert rig.peer.get_encoder(1) == 1024


def test_arm_reads_the_wireless_account_that_was_sent(rig: Rig) -> None:
    assert rig.peer.set_ssid_pwd("home", "secret words") == 1
    rig.settle()
    account = {"account": "home", "password": "secret words"}
    assert rig.texts == [("set_ssid_pwd", account)]
    assert rig.peer.set_server_port(9100) == DONE
    assert rig.state.port == 9100


def test_queries_of_pymycobot_get_replies_and_none_is_rejected(rig: Rig) -> None:
    for call, arguments in [
        ("get_system_version", ()),
        ("get_error_information", ()),
        ("get_angles_coords", ()),
        ("get_servo_voltages", ()),
        ("get_servo_temps", ()),
        ("jog_rpy", (1, 1, 50)),
        ("get_movement_type", ()),
        ("drag_get_record_len", ()),
    ]:
        assert getattr(rig.peer, call)(*arguments) != -1
        assert rig.received.pop() == call
    assert rig.rejected == []
