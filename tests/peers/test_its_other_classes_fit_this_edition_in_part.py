"""MyCobot280 and MyPalletizer260 on the simulated arm: what of them this edition understands.

MyCobot280 waits for answers like MyCobot, but sends a motion once and at once with ``_async=True``.
MyPalletizer260 sends every setter once and waits for nothing; only its rows are too short for six
joints.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cobotwire.sim.kinematics import DEGREES_A_TICK
from pymycobot_bench import Bench, driven_by, on_ticks
from pymycobot_classes import MyCobot280, MyPalletizer260

UNANSWERED = -1


@pytest.fixture(scope="module")
def connection_280() -> Iterator[Bench]:
    """One connection for the whole module: its constructor sleeps 1.5 s."""
    with driven_by(MyCobot280) as bench:
        yield bench


@pytest.fixture
def cobot(connection_280: Bench) -> Bench:
    connection_280.start_over()
    return connection_280


@pytest.fixture(scope="module")
def connection_260() -> Iterator[Bench]:
    with driven_by(MyPalletizer260) as bench:
        yield bench


@pytest.fixture
def palletizer(connection_260: Bench) -> Bench:
    connection_260.start_over()
    return connection_260


def test_the_280_makes_a_step_once_if_it_does_not_wait(cobot: Bench) -> None:
    assert cobot.peer.jog_increment(1, 10, 100, _async=True) is None
    cobot.settle()
    assert cobot.heard == ["jog_increment"]
    cobot.advance(60)
    assert cobot.angles[:1] == on_ticks(10.0)


def test_the_280_truncates_an_angle_that_our_driver_would_round(cobot: Bench) -> None:
    # 0.58 is sent as 0.57, which is nearer to the sixth tick than to the seventh.
    cobot.peer.send_angle(1, 0.58, 100, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert cobot.angles[0] == 6 * DEGREES_A_TICK != pytest.approx(0.58, abs=0.05)
    assert cobot.peer.get_angles()[0] == 0.52


def test_the_280s_coordinates_without_a_mode_are_not_obeyed(cobot: Bench) -> None:
    cobot.bend()
    before = cobot.pose
    target = [before[0] - 10, before[1] + 25.5, before[2] - 30, *before[3:]]
    cobot.peer.send_coords(target, 100, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert (cobot.heard, cobot.pose) == ([], before)
    cobot.peer.send_coords(target, 100, 0, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert cobot.heard == ["send_coords"]
    assert cobot.pose == pytest.approx(tuple(target), abs=0.8)


def test_the_280s_jogs_of_the_same_ids_are_not_taken_for_ours(cobot: Bench) -> None:
    # 0x31 is an absolute joint jog here and 0x34 stops: its frames have another LEN, and are noise.
    cobot.state.angles.go((100.0, 0, 0, 0, 0, 0), 10.0, cobot.now)
    cobot.peer.jog_rpy(1, 1, 50, _async=True)
    cobot.peer.jog_increment_coord(1, 10, 50, _async=True)
    cobot.settle()
    assert cobot.heard == []
    frames = "FE FE 05 31 01 01 32 FA", "FE FE 06 34 01 00 64 32 FA"
    assert b"".join(cobot.refused) == b"".join(map(bytes.fromhex, frames))
    cobot.advance(60)
    assert cobot.angles == on_ticks(100.0, 0, 0, 0, 0, 0)


@pytest.mark.parametrize("which", ["tool", "world"])
def test_the_280s_references_arrive_as_tenths_of_a_millimetre_and_hide_it(
    cobot: Bench, which: str
) -> None:
    # Disputed: it writes and reads x, y and z in tenths, this edition in hundredths. What it reads
    # back is what it wrote, so it never learns that the arm holds a tenth of that.
    wish = [100, 20.5, -30, 45, 0, -90]
    assert getattr(cobot.peer, f"set_{which}_reference")(wish) == UNANSWERED
    assert getattr(cobot.peer, f"get_{which}_reference")() == wish
    assert getattr(cobot.state, which) == (10.0, 2.05, -3.0, 45.0, 0.0, -90.0)


def test_the_280s_joint_limit_arrives_as_a_tenth_and_reads_back_as_one(cobot: Bench) -> None:
    # Disputed: it writes limits in tenths, this edition in hundredths; both read them in tenths.
    assert cobot.peer.get_joint_max_angle(1) == 165.0
    assert cobot.peer.set_joint_max(1, 90) == UNANSWERED
    assert cobot.state.maximum[0] == 9.0
    assert cobot.peer.get_joint_max_angle(1) == 9.0
    cobot.peer.send_angle(1, 45, 100, _async=True)
    cobot.settle()
    cobot.advance(60)
    assert cobot.angles[0] == 0.0


def test_the_280_sets_the_reference_frame_and_the_end_type(cobot: Bench) -> None:
    assert [cobot.peer.get_reference_frame(), cobot.peer.get_end_type()] == [0, 0]
    assert cobot.peer.set_reference_frame(1) == UNANSWERED
    assert cobot.peer.set_end_type(1) == UNANSWERED
    assert [cobot.peer.get_reference_frame(), cobot.peer.get_end_type()] == [1, 1]
    assert [cobot.state.reference_frame, cobot.state.end_type] == [1, 1]


def test_the_280_chooses_the_refresh_mode_and_the_newest_target_wins(cobot: Bench) -> None:
    assert cobot.peer.set_fresh_mode(1) == UNANSWERED
    assert cobot.state.fresh_mode == 1
    cobot.peer.send_angle(1, 90, 10, _async=True)
    cobot.peer.send_angle(1, -15, 100, _async=True)
    cobot.settle()
    cobot.advance(0.75)
    assert cobot.angles[:1] == on_ticks(-15.0)


def test_the_palletizer_sets_and_reads_the_speed(palletizer: Bench) -> None:
    assert palletizer.peer.get_speed() == 50
    assert palletizer.peer.set_speed(80) is None
    assert palletizer.peer.get_speed() == 80
    assert palletizer.state.speed == 80
    assert palletizer.heard == ["get_speed", "set_speed", "get_speed"]


def test_the_palletizer_switches_free_mode_on_and_off(palletizer: Bench) -> None:
    # It forgets to take the one answer out of its list.
    peer = palletizer.peer
    peer.set_free_mode(1)
    assert (peer.is_free_mode(), palletizer.state.free) == ([1], True)
    peer.set_free_mode(0)
    assert (peer.is_free_mode(), palletizer.state.free) == ([0], False)


def test_the_palletizer_jogs_to_an_angle_and_stops_a_jog(palletizer: Bench) -> None:
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


def test_the_palletizer_releases_holds_and_zeroes_single_servos(palletizer: Bench) -> None:
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


def test_the_palletizer_brakes_a_joint(palletizer: Bench) -> None:
    palletizer.peer.send_angle(1, 90, 10)
    palletizer.settle()
    palletizer.advance(2)
    palletizer.peer.joint_brake(1)
    palletizer.settle()
    palletizer.advance(60)
    assert palletizer.angles[:1] == on_ticks(30.0)


def test_the_palletizer_drives_the_gripper(palletizer: Bench) -> None:
    peer = palletizer.peer
    peer.set_gripper_state(0, 10)
    assert [peer.is_gripper_moving(), peer.get_gripper_value()] == [1, 0]
    palletizer.advance(2)
    assert [peer.is_gripper_moving(), peer.get_gripper_value()] == [1, 30]
    peer.set_gripper_calibration()
    assert [peer.is_gripper_moving(), peer.get_gripper_value()] == [0, 0]
    assert palletizer.state.gripper.position(palletizer.now) == (0.0,)


def test_the_palletizer_sets_what_a_pin_is_for(palletizer: Bench) -> None:
    palletizer.peer.set_pin_mode(23, 1)
    palletizer.settle()
    assert palletizer.state.pin_modes == {23: 1}


def test_the_palletizers_row_of_four_joints_is_not_obeyed(palletizer: Bench) -> None:
    palletizer.peer.send_angles([10, 20, 30, 40], 50)
    palletizer.settle()
    assert palletizer.heard == []
    palletizer.advance(60)
    assert palletizer.angles == (0.0,) * 6
