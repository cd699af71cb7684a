"""Test the simulated arm in the edition of today's 280."""

from __future__ import annotations

import pytest

from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import PtyServer, SimulatedArm
from simulator.bench import Bench


@pytest.fixture
def bench() -> Bench:
    return Bench(TABLE)


def test_setters_are_acknowledged_unless_acks_are_off(bench: Bench) -> None:
    assert bench.send("set_color", 1, 2, 3) == bytes.fromhex("FE FE 03 6A 01 FA")
    silent = Bench(TABLE, acks=False, powered=False)
    assert silent.send("set_color", 1, 2, 3) == b""
    assert silent.query("is_power_on") == 0


def test_limits_are_those_of_the_edition(bench: Bench) -> None:
    assert bench.query("get_joint_max_angle", 1) == 168.0
    assert bench.query("get_joint_min_angle", 2) == -140.0


def test_settings_are_read_back(bench: Bench) -> None:
    for setter, getter, value in (
        ("set_fresh_mode", "get_fresh_mode", 1),
        ("set_movement_type", "get_movement_type", 1),
        ("set_transponder_mode", "get_transponder_mode", 1),
        ("set_HTS_gripper_torque", "get_HTS_gripper_torque", 500),
        ("set_gripper_protect_current", "get_gripper_protect_current", 250),
    ):
        bench.send(setter, value)
        assert bench.query(getter) == value


def test_increment_moves_by_its_distance_and_the_plan_reports_its_target(bench: Bench) -> None:
    bench.send("send_angles", (0, -30.0, -60.0, 0, 0, 0), 50)
    bench.clock.sleep(5.0)
    height = bench.query("get_coords")[2]
    bench.send("jog_increment_coord", 3, 12.5, 50)
    planned = bench.query("get_coords_plan")[2]
    bench.clock.sleep(5.0)
    assert bench.query("get_coords")[2] == planned == pytest.approx(height + 12.5, abs=0.8)
    bench.send("send_angle", 1, 10.0, 50)
    assert bench.query("get_angles_plan")[0] == 10.01, "the tick's angle, cut to hundredths"
    bench.clock.sleep(5.0)
    angles, coords = bench.query("get_angles_coords")
    assert (angles[0], coords[2]) == (10.01, planned)


def test_servo_registers_are_backed_up_and_restored(bench: Bench) -> None:
    bench.send("backup_servo_params", 254)
    bench.send("set_servo_data", 1, 21, 99)
    assert bench.query("get_servo_data", 1, 21) == 99
    bench.send("restore_servo_params", 1)
    assert bench.query("get_servo_data", 1, 21) == 10
    bench.send("set_servo_data", 1, 30, 1000, 1)
    assert bench.query("get_servo_data", 1, 30, 1) == 1000
    assert bench.query("get_servo_data", 1, 30) == 1000 % 256


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


def test_account_is_read_from_the_text_after_the_frame() -> None:
    arm = SimulatedArm(TABLE)
    with PtyServer(arm) as server, MyCobot280(server.url) as client:
        client.set_ssid_pwd("home", "se cret")
        assert client.get_ssid_pwd().password == "se cret"
        assert arm.state.kept["ssid"] == "home"
        client.set_color(1, 2, 3)
        client.send_radians([0.1] * 6, speed=50)
        assert client.is_power_on() is False, "acknowledgements are not replies"


def test_pose_beyond_the_wire_is_reported_as_the_nearest_value(bench: Bench) -> None:
    bench.send("set_world_reference", (3276.7, 0, 0, 0, 0, 0))
    bench.send("set_reference_frame", 1)
    assert bench.query("get_coords")[0] == 3276.7
    assert "nearest" in bench.arm.notes[-1].text


def test_0x34_without_data_stops_a_jog_and_with_data_makes_a_step(bench: Bench) -> None:
    bench.send("jog_angle", 1, 0, 20)
    bench.clock.sleep(1.0)
    assert bench.query("is_moving") == 1
    # No acknowledgement: the firmware that obeys it is older.
    assert bench.send("jog_stop") == b""
    bench.clock.sleep(1.0)
    assert bench.query("is_moving") == 0
    before = bench.query("get_coords")
    bench.send("jog_increment_coord", 3, -12.5, 50)
    bench.clock.sleep(5.0)
    assert bench.query("get_coords")[2] == pytest.approx(before[2] - 12.5, abs=0.5)
