"""The maker's class MyCobot280, unmodified, drives a simulated arm of its own edition over a pty.

Here the arm acknowledges, so each setter is sent once and gives 1 at once; against the older
edition the same calls are sent three times, take 1.5 s and give -1.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.sim.state import ArmState
from pymycobot_bench import TOLD, Bench, driven_by, on_ticks
from pymycobot_classes import MyCobot280

DONE = 1


@pytest.fixture(scope="module")
def connection() -> Iterator[Bench]:
    """One connection for the whole module: its constructor sleeps 1.5 s."""
    with driven_by(MyCobot280, TABLE) as bench:
        yield bench


@pytest.fixture
def bench(connection: Bench) -> Bench:
    connection.start_over()
    return connection


def test_a_setter_is_acknowledged_and_so_sent_once_and_at_once(bench: Bench) -> None:
    started = time.monotonic()
    assert bench.peer.set_color(255, 128, 1) == DONE
    assert time.monotonic() - started < 0.45, "it waits 0.5 s where nothing answers"
    assert (bench.heard, bench.state.colour) == (["set_color"], (255, 128, 1))


def test_a_step_is_made_once(bench: Bench) -> None:
    assert bench.peer.jog_increment(1, 10, 100) == DONE
    bench.advance(60)
    assert (bench.heard, bench.angles[:1]) == (["jog_increment"], on_ticks(10.0))


def test_it_powers_the_arm_on_and_off(bench: Bench) -> None:
    bench.arm.state = ArmState(TABLE.joints, bench.state.geometry)
    peer = bench.peer
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [0, 0, 0]
    assert peer.power_on() == DONE
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [1, 1, 1]
    assert peer.is_controller_connected() == 1
    assert peer.power_off() == DONE
    assert (peer.is_power_on(), bench.state.powered) == (0, False)


def test_it_sends_all_joints_to_angles_and_reads_them_back(bench: Bench) -> None:
    target = [10.5, -20.25, 30.0, -2.58, 2.5, -160.0]
    assert bench.peer.send_angles(target, 100) == DONE
    bench.advance(60)
    assert bench.angles == on_ticks(*target)
    assert bench.peer.get_angles() == pytest.approx(target, abs=TOLD)
    assert bench.peer.is_in_position(target) == 1


def test_it_sends_and_reads_radians(bench: Bench) -> None:
    target = [0, math.pi / 4, -math.pi / 4, math.pi / 2, -math.pi / 2, 0]
    assert bench.peer.send_radians(target, 100) == DONE
    bench.advance(60)
    assert bench.angles == (0.0, 45.0, -45.0, 90.0, -90.0, 0.0)
    assert bench.peer.get_radians() == [round(radian, 3) for radian in target]


def test_it_sends_coordinates_and_reads_them_back(bench: Bench) -> None:
    bench.bend()
    before = bench.peer.get_coords()
    assert before == list(bench.pose)
    target = [before[0] - 10, before[1] + 25.5, before[2] - 30, *before[3:]]
    assert bench.peer.send_coords(target, 100, 1) == DONE
    bench.advance(60)
    assert bench.peer.get_coords() == pytest.approx(target, abs=0.8)
    assert bench.peer.is_in_position(target, 1) == 1
    assert bench.peer.send_coord(2, target[1] - 12.3, 100) == DONE
    bench.advance(60)
    assert bench.peer.get_coords()[1] == pytest.approx(target[1] - 12.3, abs=0.8)


def test_it_pauses_resumes_and_stops_a_motion(bench: Bench) -> None:
    peer = bench.peer
    bench.state.angles.go((100.0, 0, 0, 0, 0, 0), 10.0, bench.now)
    bench.advance(1)
    assert [peer.pause(), peer.is_paused()] == [DONE, 1]
    bench.advance(1)
    assert peer.is_moving() == 0
    bench.advance(5)
    assert [peer.resume(), peer.is_paused(), peer.is_moving()] == [DONE, 0, 1]
    bench.advance(1)
    assert peer.stop() == DONE
    bench.advance(1)
    assert [peer.is_moving(), bench.angles[:1]] == [0, on_ticks(20.0)]


def test_it_moves_the_gripper(bench: Bench) -> None:
    assert bench.peer.set_gripper_value(60, 100) == DONE
    bench.advance(60)
    assert [bench.peer.get_gripper_value(), bench.peer.is_gripper_moving()] == [60, 0]
    assert bench.peer.set_gripper_state(1, 100) == DONE
    bench.advance(60)
    assert bench.peer.get_gripper_value() == 0
    assert bench.peer.set_gripper_calibration() == DONE


def test_it_sets_and_reads_pins(bench: Bench) -> None:
    assert [bench.peer.get_digital_input(23), bench.peer.get_basic_input(5)] == [0, 0]
    assert [bench.peer.set_digital_output(23, 1), bench.peer.set_basic_output(5, 1)] == [DONE] * 2
    assert [bench.peer.get_digital_input(23), bench.peer.get_basic_input(5)] == [1, 1]
    assert bench.peer.set_pin_mode(23, 2) == DONE
    assert bench.state.pin_modes == {23: 2}


@pytest.mark.parametrize("which", ["tool", "world"])
def test_a_reference_arrives_in_the_scale_in_which_it_was_meant(bench: Bench, which: str) -> None:
    wish = [100, 20.5, -30, 45, 0, -90]
    assert getattr(bench.peer, f"set_{which}_reference")(wish) == DONE
    assert getattr(bench.peer, f"get_{which}_reference")() == wish
    assert getattr(bench.state, which) == tuple(wish)


def test_a_joint_limit_arrives_in_the_scale_in_which_it_was_meant(bench: Bench) -> None:
    assert bench.peer.set_joint_max(1, 90) == DONE
    assert (bench.state.maximum[0], bench.peer.get_joint_max_angle(1)) == (90.0, 90.0)
    assert bench.peer.set_joint_min(1, -45) == DONE
    assert (bench.state.minimum[0], bench.peer.get_joint_min_angle(1)) == (-45.0, -45.0)


def test_it_chooses_frame_end_and_refresh_mode(bench: Bench) -> None:
    peer = bench.peer
    assert [peer.set_reference_frame(1), peer.set_end_type(1), peer.set_fresh_mode(1)] == [DONE] * 3
    assert [peer.get_reference_frame(), peer.get_end_type()] == [1, 1]
    assert bench.state.fresh_mode == 1


def test_it_sends_encoders_and_reads_them(bench: Bench) -> None:
    assert bench.peer.set_encoders([1024, 2048, 2560, 2048, 2048, 2049], 100) == DONE
    bench.advance(60)
    assert bench.peer.get_encoders() == [1024, 2048, 2560, 2048, 2048, 2049]
    assert bench.peer.get_encoder(1) == 1024


def test_it_names_a_wireless_account_and_the_arm_understands_it(bench: Bench) -> None:
    assert bench.peer.set_ssid_pwd("home", "secret words") == 1
    bench.settle()
    account = {"account": "home", "password": "secret words"}
    assert bench.told == [("set_ssid_pwd", account)]
    assert bench.peer.set_server_port(9100) == DONE
    assert bench.state.port == 9100


def test_nothing_that_it_says_in_a_session_is_noise_to_the_arm(bench: Bench) -> None:
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
        assert getattr(bench.peer, call)(*arguments) != -1
        assert bench.heard.pop() == call
    assert bench.refused == []
