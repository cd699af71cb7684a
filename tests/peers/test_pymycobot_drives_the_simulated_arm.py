"""The maker's library, unmodified, drives the simulated arm: its class MyCobot, over a real pty.

In this edition nothing answers a setter. pymycobot waits for an answer all the same, so each of its
setters is sent three times, takes 1.5 s and gives -1. The arm does what it was told nevertheless.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import pytest

from cobotwire.editions.mycobot import TABLE
from cobotwire.sim.state import ArmState
from pymycobot_bench import TOLD, Bench, driven_by, on_ticks
from pymycobot_classes import MyCobot

UNANSWERED = -1


@pytest.fixture(scope="module")
def connection() -> Iterator[Bench]:
    """One connection for the whole module."""
    with driven_by(MyCobot) as bench:
        yield bench


@pytest.fixture
def bench(connection: Bench) -> Bench:
    connection.start_over()
    return connection


def test_a_setter_is_sent_three_times_and_takes_a_second_and_a_half(bench: Bench) -> None:
    started = time.monotonic()
    assert bench.peer.set_color(255, 128, 1) == UNANSWERED
    assert 1.4 < time.monotonic() - started < 3
    assert bench.heard == ["set_color"] * 3
    assert bench.state.colour == (255, 128, 1)


def test_a_query_is_sent_once_because_it_is_answered(bench: Bench) -> None:
    assert bench.peer.get_angles() == [0.0] * 6
    assert bench.heard == ["get_angles"]


def test_a_step_is_made_three_times(bench: Bench) -> None:
    # This is why cobotwire never sends anything twice: 10 degrees were asked for.
    bench.peer.jog_increment(1, 10, 100)
    assert bench.heard == ["jog_increment"] * 3
    bench.advance(60)
    assert bench.angles == pytest.approx((30.0, 0, 0, 0, 0, 0), abs=0.1)


def test_it_powers_the_arm_on_and_off(bench: Bench) -> None:
    bench.arm.state = ArmState(TABLE.joints, bench.state.geometry)
    peer = bench.peer
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [0, 0, 0]
    assert peer.power_on() == UNANSWERED
    assert [peer.is_power_on(), peer.is_servo_enable(3), peer.is_all_servo_enable()] == [1, 1, 1]
    assert bench.state.powered
    assert peer.is_controller_connected() == 1
    assert peer.power_off() == UNANSWERED
    assert peer.is_power_on() == 0
    assert not bench.state.powered


def test_it_releases_all_servos(bench: Bench) -> None:
    assert bench.peer.release_all_servos() == UNANSWERED
    assert bench.peer.is_all_servo_enable() == 0
    assert bench.state.enabled == [False] * 6


def test_it_sends_all_joints_to_angles_and_reads_them_back(bench: Bench) -> None:
    # -2.58 degrees are FE FE on the wire and 2.5 are 00 FA: header and footer inside the data.
    target = [10.5, -20.25, 30.0, -2.58, 2.5, -160.0]
    assert bench.peer.send_angles(target, 100) == UNANSWERED
    bench.advance(60)
    assert bench.angles == on_ticks(*target)
    assert bench.peer.get_angles() == pytest.approx(target, abs=TOLD)
    radians = [math.radians(angle) for angle in target]
    assert bench.peer.get_radians() == pytest.approx(radians, abs=0.002)


def test_it_sends_one_joint_and_sees_it_on_the_way(bench: Bench) -> None:
    assert bench.peer.send_angle(3, -75, 50) == UNANSWERED
    bench.advance(0.6875)
    assert bench.peer.is_moving() == 1
    # 75 degrees a second take 0.375 s to reach: half of the way is done after 0.6875 s.
    assert bench.peer.get_angles() == pytest.approx([0, 0, -37.5, 0, 0, 0], abs=TOLD)
    assert bench.peer.is_in_position([0, 0, -75, 0, 0, 0], 0) == 0
    bench.advance(1)
    assert bench.peer.is_moving() == 0
    assert bench.peer.is_in_position([0, 0, -75, 0, 0, 0], 0) == 1
    assert bench.angles[2:3] == on_ticks(-75.0)


def test_it_sends_coordinates_and_reads_them_back(bench: Bench) -> None:
    bench.bend()
    before = bench.peer.get_coords()
    assert before == list(bench.pose)
    target = [before[0] - 10, before[1] + 25.5, before[2] - 30, *before[3:]]
    assert bench.peer.send_coords(target, 100, 1) == UNANSWERED
    bench.advance(60)
    assert bench.peer.get_coords() == pytest.approx(target, abs=0.8)
    assert bench.peer.is_in_position(target, 1) == 1


@pytest.mark.parametrize(("axis", "value"), [(2, -33.3), (6, -77.5)])
def test_it_sends_one_coordinate(bench: Bench, axis: int, value: float) -> None:
    bench.bend()
    expected = list(bench.pose)
    assert bench.peer.send_coord(axis, value, 100) == UNANSWERED
    bench.advance(60)
    expected[axis - 1] = value
    assert bench.peer.get_coords() == pytest.approx(expected, abs=0.8)


def test_it_pauses_resumes_and_stops_a_motion(bench: Bench) -> None:
    peer = bench.peer
    bench.state.angles.go((100.0, 0, 0, 0, 0, 0), 10.0, bench.now)
    bench.advance(1)
    assert peer.pause() == UNANSWERED
    bench.advance(5)
    assert [peer.is_paused(), peer.is_moving(), bench.angles[:1]] == [1, 0, on_ticks(10.0)]
    assert peer.resume() == UNANSWERED
    bench.advance(1)
    assert [peer.is_paused(), peer.is_moving(), bench.angles[:1]] == [0, 1, on_ticks(19.75)]
    assert peer.stop() == UNANSWERED
    bench.advance(5)
    assert [peer.is_moving(), bench.angles[:1], bench.state.stopped] == [0, on_ticks(20.0), True]


def test_it_jogs_a_joint_and_a_coordinate(bench: Bench) -> None:
    # Sent three times, it goes on as it went.
    assert bench.peer.jog_angle(2, 0, 10) == UNANSWERED
    bench.advance(1)
    assert bench.angles == on_ticks(0.0, -15.0 + 0.5625, 0.0, 0.0, 0.0, 0.0)
    bench.bend()
    x, y, height = bench.pose[:3]
    assert bench.peer.jog_coord(3, 1, 10) == UNANSWERED
    bench.advance(1)
    assert bench.pose[:2] == pytest.approx((x, y), abs=0.8)
    assert bench.pose[2] > height + 10


def test_it_sends_and_reads_encoders(bench: Bench) -> None:
    assert bench.peer.get_encoders() == [2048] * 6
    assert bench.peer.set_encoders([1024, 2048, 2560, 2048, 2048, 2049], 100) == UNANSWERED
    bench.advance(60)
    assert bench.peer.get_encoders() == [1024, 2048, 2560, 2048, 2048, 2049]
    assert bench.peer.get_encoder(1) == 1024
    assert bench.angles[:3] == (90.0, 0.0, 45.0), "these stand on ticks"


def test_its_set_encoder_is_not_obeyed_because_it_carries_a_speed(bench: Bench) -> None:
    assert bench.peer.set_encoder(1, 1024, 50) == UNANSWERED
    assert bench.heard == []
    assert b"".join(bench.refused) == bytes.fromhex("FE FE 06 3A 01 04 00 32 FA") * 3
    bench.advance(60)
    assert bench.angles == (0.0,) * 6


def test_it_moves_the_gripper(bench: Bench) -> None:
    assert bench.peer.set_gripper_value(60, 100) == UNANSWERED
    bench.advance(60)
    assert bench.state.gripper.position(bench.now) == (60.0,)
    assert bench.peer.set_gripper_state(1, 100) == UNANSWERED
    bench.advance(60)
    assert bench.state.gripper.position(bench.now) == (0.0,)


def test_it_sets_and_reads_pins(bench: Bench) -> None:
    assert [bench.peer.get_digital_input(23), bench.peer.get_basic_input(5)] == [0, 0]
    assert bench.peer.set_digital_output(23, 1) == UNANSWERED
    assert bench.peer.set_basic_output(5, 1) == UNANSWERED
    assert [bench.peer.get_digital_input(23), bench.peer.get_basic_input(5)] == [1, 1]
    assert (bench.state.pins, bench.state.basic_pins) == ({23: True}, {5: True})


def test_it_writes_and_reads_servo_registers(bench: Bench) -> None:
    assert bench.peer.get_servo_data(2, 21) == 10
    assert bench.peer.set_servo_data(2, 21, 25) == UNANSWERED
    assert bench.peer.get_servo_data(2, 21) == 25
    assert [registers[21] for registers in bench.state.registers[:6]] == [10, 25, 10, 10, 10, 10]


def test_it_reads_the_limits_of_a_joint_as_tenths_without_converting_them(bench: Bench) -> None:
    # MyCobot280 and MyPalletizer260 divide by ten; this class forgets to.
    bench.state.minimum[2], bench.state.maximum[2] = -150.5, 150.5
    assert bench.peer.get_joint_min_angle(3) == -1505
    assert bench.peer.get_joint_max_angle(3) == 1505


def test_it_reads_the_account_and_sets_the_port(bench: Bench) -> None:
    assert bench.peer.get_ssid_pwd() == ("MyCobotWiFi2.4G", "mycobot123")
    assert bench.peer.set_server_port(9100) == UNANSWERED
    assert bench.state.port == 9100
