"""Draw the arm as a stick figure."""

from __future__ import annotations

import math
import signal
import time
from itertools import pairwise
from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import UsageError
from cobotwire.cli.app import app
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.inspect.plot import draw_pose
from cobotwire.inspect.plot.pose import points
from cobotwire.kinematics import coords_of, geometry_of
from cobotwire.protocol.robot import Robot
from command_line import printed, started

# The lengths of the arm's parts in millimetres, from kinematics.md.
LENGTHS = [131.22, 110.4, 96.0, 64.62, 73.18, 48.6]


@given(st.lists(st.floats(-165, 165), min_size=6, max_size=6))
def test_stick_figure_has_the_lengths_of_the_arm_and_ends_at_the_flange(
    angles: list[float],
) -> None:
    found = points(TABLE, angles)
    assert [math.dist(one, two) for one, two in pairwise(found)] == pytest.approx(LENGTHS)
    geometry = geometry_of(TABLE)
    assert geometry is not None
    assert found[-1] == pytest.approx(coords_of(geometry, angles)[:3])


def test_picture_states_joint_angles_and_flange_position(tmp_path: Path) -> None:
    path = tmp_path / "pose.svg"
    draw_pose(TABLE, [0] * 6, str(path))
    drawn = path.read_text()
    for text in ("J1 0.0°", "flange at x", "from the side", "from above", "height z, mm"):
        assert text in drawn, text


def test_picture_of_an_unverified_geometry_names_its_file(tmp_path: Path) -> None:
    path, geometry = tmp_path / "pose.svg", TABLE.robot.geometry
    assert geometry is not None
    robot = TABLE.robot._replace(geometry=geometry._replace(unverified="a$1$.urdf"))
    draw_pose(TABLE._replace(robot=robot), [0] * 6, str(path))
    assert "the geometry is that of a$1$.urdf, unverified" in path.read_text()


def test_pose_of_an_arm_with_unknown_geometry_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="edition mine: the geometry of this arm is not known"):
        draw_pose(
            TABLE._replace(edition="mine", robot=Robot()), [0] * 6, str(tmp_path / "pose.png")
        )


def test_pose_of_a_recording_without_joints_is_rejected(tmp_path: Path) -> None:
    stream = tmp_path / "arm.bin"
    stream.write_bytes(bytes.fromhex("FE FE 03 12 01 FA") * 3)
    words = ["--edition", "mycobot280", "plot", str(stream), "--pose", "-o", f"{tmp_path}/pose.png"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 2
    assert "holds no reply with joint angles" in result.output


def test_sim_view_keeps_the_picture_up_to_date(tmp_path: Path) -> None:
    path = tmp_path / "view.svg"
    with started("sim", "--quiet", "--view", path) as sim:
        url = printed(sim).strip()
        assert "J1 0.0°" in path.read_text()
        with MyCobot280(url, timeout=30) as arm:
            arm.power_on()
            arm.move_angles([45, 0, 0, 0, 0, 0], 100)
            until = time.monotonic() + 60
            while "J1 45.0°" not in path.read_text():
                assert time.monotonic() < until
                time.sleep(0.05)
            arm.send_angles([0] * 6, 100)
            time.sleep(0.3)  # the arm is moving
        sim.send_signal(signal.SIGTERM)
        assert sim.wait(timeout=60) == 143
        assert "J1 45.0°" not in path.read_text()
