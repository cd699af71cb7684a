"""Check which calls of MyCobot280 and MyPalletizer260 work on an arm of edition mycobot.

MyCobot280 waits for replies like MyCobot, but with ``_async=True`` it sends a motion once and does
not wait. MyPalletizer260 sends every setter once and does not wait; its rows are too short for six
joints.
"""

from __future__ import annotations

import pytest

from kinematic_samples import ENCODERS
from pymycobot_classes import MyCobot280, MyPalletizer260
from pymycobot_rig import Rig, on_ticks, rig_fixtures

UNANSWERED = -1


opened_280, cobot = rig_fixtures(MyCobot280, connection="connection_280")
opened_260, palletizer = rig_fixtures(MyPalletizer260, connection="connection_260")


def test_280_step_with_async_flag_moves_the_arm_once(cobot: Rig) -> None:
    assert cobot.peer.jog_increment(1, 10, 100, _async=True) is None
    cobot.settle()
    assert cobot.received == ["jog_increment"]
    cobot.advance(60)
    assert cobot.angles[:1] == on_ticks(10.0)


def test_280_angle_between_steps_is_truncated_where_ours_is_rounded(cobot: Rig) -> None:
    # 0.58 is sent as 0.57, which is nearer to the sixth tick than to the seventh.
    cobot.peer.send_angle(1, 0.58, 100, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert cobot.angles[0] == 6 * ENCODERS.degrees != pytest.approx(0.58, abs=0.05)
    assert cobot.peer.get_angles()[0] == 0.52


def test_280_coordinates_without_a_mode_are_rejected(cobot: Rig) -> None:
    cobot.bend()
    before = cobot.pose
    target = [before[0] - 10, before[1] + 25.5, before[2] - 30, *before[3:]]
    cobot.peer.send_coords(target, 100, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert (cobot.received, cobot.pose) == ([], before)
    cobot.peer.send_coords(target, 100, 0, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert cobot.received == ["send_coords"]
    assert cobot.pose == pytest.approx(tuple(target), abs=0.8)


def test_280_jogs_with_the_same_ids_are_noise_here(cobot: Rig) -> None:
    # 0x31 is an absolute joint jog here and 0x34 stops: its frames have another LEN, and are noise.
    cobot.state.angles.go((100.0, 0, 0, 0, 0, 0), 10.0, cobot.now)
    cobot.peer.jog_rpy(1, 1, 50, _async=True)
    cobot.peer.jog_increment_coord(1, 10, 50, _async=True)
    cobot.settle()
    assert cobot.received == []
    frames = "FE FE 05 31 01 01 32 FA", "FE FE 06 34 01 00 64 32 FA"
    assert b"".join(cobot.rejected) == b"".join(map(bytes.fromhex, frames))
    cobot.advance(60)
    assert cobot.angles == on_ticks(100.0, 0, 0, 0, 0, 0)


@pytest.mark.parametrize("which", ["tool", "world"])
def test_280_reference_arrives_ten_times_too_small_but_reads_back_as_sent(
    cobot: Rig, which: str
) -> None:
    # Disputed: pymycobot writes and reads x, y and z in tenths, this edition in hundredths. It
    # reads back what it wrote, so it cannot notice that the arm holds a tenth of that.
    reference = [100, 20.5, -30, 45, 0, -90]
    assert getattr(cobot.peer, f"set_{which}_reference")(reference) == UNANSWERED
    assert getattr(cobot.peer, f"get_{which}_reference")() == reference
    assert getattr(cobot.state, which) == (10.0, 2.05, -3.0, 45.0, 0.0, -90.0)


def test_280_joint_limit_arrives_ten_times_too_small_and_reads_back_too_small(cobot: Rig) -> None:
    # Disputed: pymycobot writes limits in tenths, this edition in hundredths. Both read tenths.
    assert cobot.peer.get_joint_max_angle(1) == 165.0
    assert cobot.peer.set_joint_max(1, 90) == UNANSWERED
    assert cobot.state.maximum[0] == 9.0
    assert cobot.peer.get_joint_max_angle(1) == 9.0
    cobot.peer.send_angle(1, 45, 100, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert cobot.angles[0] == 0.0


def test_280_reference_frame_and_end_type_read_back(cobot: Rig) -> None:
    assert [cobot.peer.get_reference_frame(), cobot.peer.get_end_type()] == [0, 0]
    assert cobot.peer.set_reference_frame(1) == UNANSWERED
    assert cobot.peer.set_end_type(1) == UNANSWERED
    assert [cobot.peer.get_reference_frame(), cobot.peer.get_end_type()] == [1, 1]
    assert [cobot.state.reference_frame, cobot.state.end_type] == [1, 1]


def test_280_refresh_mode_makes_the_newest_target_win(cobot: Rig) -> None:
    assert cobot.peer.set_fresh_mode(1) == UNANSWERED
    assert cobot.state.fresh_mode == 1
    cobot.peer.send_angle(1, 90, 10, _async=True)
    cobot.peer.send_angle(1, -15, 100, _async=True)
    cobot.settle()
    cobot.advance(0.75)
    assert cobot.angles[:1] == on_ticks(-15.0)


def test_palletizer_speed_reads_back(palletizer: Rig) -> None:
    assert palletizer.peer.get_speed() == 50
    assert palletizer.peer.set_speed(80) is None
    assert palletizer.peer.get_speed() == 80
    assert palletizer.state.speed == 80
    assert palletizer.received == ["get_speed", "set_speed", "get_speed"]


def test_palletizer_free_mode_reads_back_in_a_list(palletizer: Rig) -> None:
    # pymycobot returns a list with the only value.
    peer = palletizer.peer
    peer.set_free_mode(1)
    assert (peer.is_free_mode(), palletizer.state.free) == ([1], True)
    peer.set_free_mode(0)
    assert (peer.is_free_mode(), palletizer.state.free) == ([0], False)


def test_palletizer_jogs_to_an_angle_and_stops_a_jog(palletizer: Rig) -> None:
    palletizer.peer.jog_absolute(2, -30.5, 100)
    palletizer.settle()
    palletizer.advance(60)
    assert palletizer.angles[1:2] == on_ticks(-30.5)
    palletizer.peer.jog_angle(1, 1, 10)
    palletizer.settle()
    palletizer.advance(2)
    palletizer.peer.jog_stop()
    palletizer.settle()
    palletizer.advance(60)
    assert palletizer.angles[:2] == on_ticks(30.0, -30.5)


def test_palletizer_releases_holds_and_zeroes_single_servos(palletizer: Rig) -> None:
    peer, state = palletizer.peer, palletizer.state
    peer.release_servo(2)
    assert [peer.is_servo_enable(joint) for joint in (1, 2)] == [1, 0]
    assert state.enabled == [True, False, True, True, True, True]
    peer.focus_servo(2)
    palletizer.settle()
    assert state.enabled == [True] * 6
    state.angles.place((12.0, 34.0, 0, 0, 0, 0), palletizer.now)
    peer.set_servo_calibration(2)
    palletizer.settle()
    assert palletizer.angles == on_ticks(12.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_palletizer_brake_stops_a_joint(palletizer: Rig) -> None:
    palletizer.peer.send_angle(1, 90, 10)
    palletizer.settle()
    palletizer.advance(2)
    palletizer.peer.joint_brake(1)
    palletizer.settle()
    palletizer.advance(60)
    assert palletizer.angles[:1] == on_ticks(30.0)


def test_palletizer_gripper_state_moves_the_gripper(palletizer: Rig) -> None:
    peer = palletizer.peer
    peer.set_gripper_state(0, 10)
    assert [peer.is_gripper_moving(), peer.get_gripper_value()] == [1, 0]
    palletizer.advance(2)
    assert [peer.is_gripper_moving(), peer.get_gripper_value()] == [1, 30]
    peer.set_gripper_calibration()
    assert [peer.is_gripper_moving(), peer.get_gripper_value()] == [0, 0]
    assert palletizer.state.gripper.position(palletizer.now) == (0.0,)


def test_palletizer_pin_mode_is_set(palletizer: Rig) -> None:
    palletizer.peer.set_pin_mode(23, 1)
    palletizer.settle()
    assert palletizer.state.pin_modes == {23: 1}


def test_palletizer_row_of_four_joints_is_rejected(palletizer: Rig) -> None:
    palletizer.peer.send_angles([10, 20, 30, 40], 50)
    palletizer.settle()
    assert palletizer.received == []
    palletizer.advance(60)
    assert palletizer.angles == (0.0,) * 6
