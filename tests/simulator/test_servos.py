"""Test what the servos of the simulated arm report, and what a restart keeps."""

from __future__ import annotations

import random

import pytest

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from kinematic_samples import random_angles
from simulator.bench import Bench

REFERENCE = codecs.load(TABLE, "reference")
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


def test_angles_to_coords_of_get_angles_equals_get_coords(bench: Bench) -> None:
    rng = random.Random(6)
    for _ in range(50):
        bench.arm.state.angles.place(random_angles(rng), bench.clock())
        calculated = bench.query("angles_to_coords", bench.query("get_angles"))
        assert calculated == bench.query("get_coords")


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


def test_motions_are_acknowledged_when_they_are_received(bench: Bench) -> None:
    assert bench.send("send_angle", 1, 30.0, 1) == bytes.fromhex("FE FE 03 21 01 FA")
    assert bench.query("is_moving") == 1
    assert bench.query("check_async_or_sync") == 0, "so it works asynchronously"


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
