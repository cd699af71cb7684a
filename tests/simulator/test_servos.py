"""Test the simulated 280: its servos, their records and limits, and what a restart keeps."""

from __future__ import annotations

import pytest

from cobotwire.editions.mycobot280 import TABLE
from simulator.bench import Bench

STEPS_A_DEGREE = 4096 / 360


@pytest.fixture
def bench() -> Bench:
    return Bench(TABLE)


def test_servo_speeds_have_the_signs_of_the_encoders(bench: Bench) -> None:
    assert bench.query("get_servo_speeds") == (0,) * 6
    bench.send("send_angles", (90.0, 0.0, 90.0, 0.0, 45.0, 0.0), 40)
    bench.clock.sleep(0.8)
    cruise = round(60 * STEPS_A_DEGREE)
    assert bench.query("get_servo_speeds") == (
        -cruise,
        0,
        cruise,
        0,
        -round(30 * STEPS_A_DEGREE),
        0,
    )
    before = bench.query("get_encoders")
    bench.clock.sleep(0.1)
    gone = [b - a for a, b in zip(before, bench.query("get_encoders"))]
    assert gone == pytest.approx([v / 10 for v in bench.query("get_servo_speeds")], abs=1)
    bench.clock.sleep(10)
    assert bench.query("get_servo_speeds") == (0,) * 6


def test_braking_arm_reports_its_servo_speeds(bench: Bench) -> None:
    bench.send("send_angle", 3, 100.0, 40)
    bench.clock.sleep(1.0)
    bench.send("stop")
    bench.clock.sleep(0.1)
    assert bench.query("get_servo_speeds")[2] == round((60 - 0.1 * 200) * STEPS_A_DEGREE)


def test_gripper_encoder_is_read_back_as_set(bench: Bench) -> None:
    bench.send("set_encoder", 7, 2048 + 70, 50)
    bench.clock.sleep(5)
    assert (bench.query("get_encoder", 7), bench.query("get_gripper_value")) == (2118, 70)
    bench.send("set_encoder", 7, 1000, 50)
    assert "2048 to 2148" in bench.arm.notes[-1].text
    bench.clock.sleep(5)
    assert bench.query("get_gripper_value") == 70


def test_motion_of_a_paused_arm_waits_with_a_note(bench: Bench) -> None:
    bench.send("pause")
    for motion in (("send_angle", 1, 30.0, 50), ("jog_angle", 2, 1, 50), ("jog_coord", 3, 0, 50)):
        before = len(bench.arm.notes)
        bench.send(*motion)
        [note] = bench.arm.notes[before:]
        assert (note.command, "waits" in note.text) == (motion[0], True)
    bench.send("resume")
    bench.send("send_angle", 1, 30.0, 50)
    assert len(bench.arm.notes) == 3


def test_restart_loses_settings_but_moves_no_joint(bench: Bench) -> None:
    assert bench.query("get_reboot_count") == 1
    bench.send("send_angles", (90.0, -45.0, 22.5, 0.0, 45.0, -90.0), 60)
    bench.send("set_gripper_value", 40, 50)
    bench.clock.sleep(0.9)
    bench.send("set_fresh_mode", 1)
    stood = bench.query("get_angles"), bench.query("get_gripper_value")
    other = bench.arm.connect()
    other.restart()
    bench.clock.sleep(1)
    assert (bench.query("get_angles"), bench.query("get_gripper_value")) == stood
    assert stood[0][0] > 10
    assert (bench.query("is_power_on"), bench.query("get_fresh_mode")) == (0, 0)
    assert bench.query("get_joint_max_angle", 1) == 168.0, "the edition's limits come back"
    assert bench.query("get_reboot_count") == 2


def test_restored_servo_has_its_backup_or_else_factory_registers(bench: Bench) -> None:
    bench.send("set_servo_data", 1, 21, 11)
    bench.send("set_servo_data", 2, 21, 12)
    bench.send("restore_servo_params", 2)
    assert bench.query("get_servo_data", 2, 21) == 10
    bench.send("backup_servo_params", 254)
    for joint in (1, 6):
        bench.send("set_servo_data", joint, 21, 99)
    bench.send("restore_servo_params", 6)
    assert [bench.query("get_servo_data", joint, 21) for joint in (1, 6)] == [99, 10]
    bench.send("restore_servo_params", 1)
    assert [bench.query("get_servo_data", joint, 21) for joint in (1, 2)] == [11, 10]


def test_recorded_motion_is_read_point_by_point(bench: Bench) -> None:
    assert bench.query("drag_start_record") == 1
    assert bench.query("drag_end_record") == 2
    assert bench.query("drag_get_record_len") == 2
    assert bench.query("drag_get_record_data")[::2] == (2048,) * 6
    bench.send("drag_get_record_data")
    assert bench.query("drag_get_record_data") == (0,) * 12, "zeros after the last point"
    assert bench.query("drag_clear_record_data") == 0


def test_all_servos_are_held_at_once(bench: Bench) -> None:
    bench.send("release_all_servos")
    assert bench.query("is_all_servo_enable") in (0, (0, (0,) * 5))
    bench.send("focus_all_servos", 0)
    assert bench.query("is_servo_enable", 6) == 1


def test_pose_that_a_reply_cannot_encode_is_reported_as_the_nearest_value(bench: Bench) -> None:
    bench.send("set_world_reference", (3276.7, 0, 0, 0, 0, 0))
    bench.send("set_reference_frame", 1)
    assert bench.query("get_coords")[0] == 3276.7
    assert "nearest" in bench.arm.notes[-1].text
