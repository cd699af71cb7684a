"""Test that the simulated arm takes every number of its robot from the edition."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.editions.mecharm270 import TABLE as MECHARM
from cobotwire.editions.mercury_a1 import TABLE as MERCURY
from cobotwire.editions.mycobot import TABLE as DOCUMENT
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.editions.mypalletizer260 import TABLE as PALLETIZER
from cobotwire.kinematics import Pose, flange, geometry_of
from cobotwire.kinematics.ticks import Steps, reported_coords
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.robot import (
    Dimensions,
    Encoders,
    ErrorCodes,
    Gripper,
    Robot,
    Servos,
    load_robot,
)
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm, SteppedClock
from cobotwire.simulator.start import steps
from simulator.bench import Bench
from trial_specs import HEAD, edition_of

# Angles and coordinates of a real mechArm 270, from a public program (see its edition).
MECHARM_PAIRS = (
    ((5.62, 72.33, -80.77, -1.93, 70.83, -1.58), (228.8, 20.4, 134.3, -177.01, 27.51, -171.87)),
    ((6.06, 111.79, -106.69, 0.35, 70.83, -1.58), (214.8, 23.2, 36.2, -179.96, 14.06, -172.42)),
    ((0.96, 105.82, -74.97, -1.84, 53.96, 175.78), (199.0, 2.0, -2.2, 178.1, -5.04, 6.32)),
)


def _with(**parts: Any) -> Table:
    return TABLE._replace(robot=TABLE.robot._replace(**parts))


def test_encoders_count_as_the_edition_states() -> None:
    signs = (1, -1, 1, 1, 1, 1)
    bench = Bench(_with(encoders=Encoders(1000, 400, 800, signs)))
    bench.send("send_angles", (36.0, 36.0, 150.0, 0.1, -150.0, 0.0), 100)
    bench.clock.sleep(5)
    # The third is the highest reading, the fifth the lowest.
    assert bench.query("get_encoders")[:5] == (500, 300, 800, 400, 0)
    assert bench.query("get_angles")[3] == 0.0, "a tick is 0.36 degrees"


def test_gripper_reads_as_the_edition_states() -> None:
    bench = Bench(_with(gripper=Gripper(2.0, 10, 210)))
    assert bench.query("get_encoder", 7) == 10
    bench.send("set_gripper_value", 50, 10, 1)
    bench.clock.sleep(1.25)
    assert bench.query("get_encoder", 7) == 60, "it opens by 20 percent a second"
    bench.clock.sleep(5)
    assert bench.query("get_encoder", 7) == 110


def test_rejected_motion_has_the_number_that_the_edition_states() -> None:
    bench = Bench(_with(error_codes=ErrorCodes((21, 22, 23, 24, 25, 26), 40, 41)))
    bench.arm.state.maximum[2] = 10.0
    bench.send("send_angle", 3, 20.0, 50)
    assert bench.query("get_error_information") == 23
    bench.send("send_coords", (10.0, 10.0, 10.0, 0.0, 0.0, 0.0), 50, 0)
    assert bench.query("get_error_information") == 40


def test_servos_report_what_the_edition_states() -> None:
    start = {"kind": "quantity", "each": ["joint"], "start": 24.0}
    state = {**TABLE.robot.state, "servo_voltages": start}
    bench = Bench(_with(servos=Servos(((21, 9),)), state=state))
    assert bench.query("get_servo_data", 2, 21, 0) == 9
    assert bench.query("get_servo_voltages") == (24.0,) * 6
    assert bench.query("get_servo_temps") == (30,) * 6


def test_arm_begins_at_its_start_angles() -> None:
    start = (10.0, 20.0, -30.0, 0.0, 0.0, 5.0)
    angles = Bench(_with(start_angles=start)).query("get_angles")
    assert angles == pytest.approx(start, abs=0.06)


def test_query_reports_its_start_value_until_something_is_set() -> None:
    bench = Bench(TABLE)
    assert bench.query("get_system_version") == 6.5
    assert bench.query("get_gripper_protect_current") == 100
    bench.send("set_gripper_protect_current", 300)
    assert bench.query("get_gripper_protect_current") == 300
    bench.arm.restart()
    assert bench.query("get_gripper_protect_current") == 100


def test_limits_are_the_ranges_of_targets_or_else_those_of_the_robot() -> None:
    assert joint_limits(DOCUMENT) == [(-165, 165)] * 6, "the document gives targets no range"
    assert joint_limits(TABLE)[0] == (-168, 168)
    assert joint_limits(DOCUMENT._replace(robot=Robot())) == []


def test_links_say_which_joints_turn_them() -> None:
    still = {"offset": 0, "alpha": 0, "a": 0, "d": 0, "turned_by": []}
    links = [
        {**still, "d": 1, "turned_by": [{"joint": 1, "share": 1}]},
        {**still, "a": "1/2", "turned_by": [{"joint": 1, "share": "-1/2"}]},
        still,
    ]
    geometry = load_robot({"geometry": {"links": links, "doc": ""}}).geometry
    assert geometry is not None
    assert [link[4] for link in geometry.links] == [((0, 1.0),), ((0, -0.5),), ()]
    found = geometry_of(TABLE._replace(robot=Robot(geometry)))
    assert found is not None
    assert [*found.link_angles([40.0])] == [40.0, -20.0, 0]
    assert found.joints == 1


@pytest.mark.parametrize(("own", "has_one"), [("", True), ("joints: 5\n", False)])
def test_geometry_is_inherited_only_with_the_joints(
    tmp_path: Path, own: str, has_one: bool
) -> None:
    delta, _ = edition_of(f"{HEAD}base: cobotwire:mycobot280\n{own}", tmp_path)
    assert (delta.robot.geometry is not None) == has_one


def test_geometry_is_exact_and_does_not_depend_on_the_name_of_the_edition() -> None:
    known = geometry_of(TABLE._replace(edition="another"))
    assert known is not None
    assert (known.links[0].d, known.links[1].a, known.links[5].d) == (131.22, -110.4, 48.6)


@pytest.mark.parametrize(("angles", "coords"), MECHARM_PAIRS)
def test_geometry_of_the_mecharm_fits_positions_of_a_real_one(
    angles: tuple[float, ...], coords: tuple[float, ...]
) -> None:
    geometry = geometry_of(MECHARM)
    assert geometry is not None
    way, turn = flange(geometry, angles).distance(Pose.of(coords))
    assert way <= 0.4
    assert turn <= 0.1


# A level end, for an arm with four coordinates. The lengths are examples.
LEVEL = Dimensions(
    (
        (0.0, 90.0, 0.0, 120.0, ((0, 1.0),)),
        (90.0, 0.0, 140.0, 0.0, ((1, 1.0),)),
        (-90.0, 0.0, 134.0, 0.0, ((2, 1.0),)),
        (0.0, 90.0, 44.0, 0.0, ((1, -1.0), (2, -1.0))),
        (0.0, 0.0, 0.0, -20.0, ((3, 1.0),)),
    )
)


def test_arm_with_four_coordinates_moves_its_end() -> None:
    robot = PALLETIZER.robot._replace(geometry=LEVEL)
    bench = Bench(PALLETIZER._replace(robot=robot))
    bench.send("send_angles", (20.0, 30.0, -20.0, 45.0), 100)
    bench.clock.sleep(10)
    x, y, z, theta = bench.query("get_coords")
    bench.send("send_coords", (x - 20, y + 10, z + 15, theta - 30), 100)
    bench.clock.sleep(10)
    assert bench.arm.notes == ()
    moved = bench.query("get_coords")
    assert moved == pytest.approx((x - 20, y + 10, z + 15, theta - 30), abs=0.5)
    bench.send("send_coord", 4, theta, 100)
    bench.clock.sleep(10)
    assert bench.query("get_coords") == pytest.approx((x - 20, y + 10, z + 15, theta), abs=0.5)
    assert bench.query("is_in_position", (x - 20, y + 10, z + 15, theta), 1)


def test_event_of_a_rejected_motion_has_the_number_of_its_joint() -> None:
    clock = SteppedClock()
    arm = SimulatedArm(MERCURY, clock=clock, powered=True)
    codec = codecs.load(MERCURY, "reference")
    arm.state.maximum[2] = 10.0
    targets = (0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 0.0)
    sent = arm.receive(codec.encode("send_angles", "request", (targets, 50)))
    clock.sleep(1)
    sent += arm.flush()
    framer = codec.framer("reply")
    replies = [event.message for event in framer.feed(sent) if isinstance(event, Frame)]
    assert [reply.command.name for reply in replies] == ["send_angles", "motion_ended"]
    assert replies[1].fields["status"] == 3


def test_reported_values_are_truncated_to_the_steps_of_the_replies() -> None:
    assert steps(TABLE) == Steps(100, (10, 10, 10, 100, 100, 100))
    assert steps(PALLETIZER) == Steps(100, (10, 10, 10, 0, 0, 100))
    assert steps(MERCURY).angle != 100, "it reports finer angles"
    assert reported_coords((1.26, -1.26, 0.19, 1.999, -1.999, 0.0), steps(TABLE)) == (
        *(1.2, -1.2, 0.1),
        *(1.99, -1.99, 0.0),
    )


def test_arm_says_why_its_geometry_is_not_known() -> None:
    table = PALLETIZER
    arm = SimulatedArm(table, powered=True)
    arm.receive(codecs.load(table).encode("get_coords", "request", ()))
    assert arm.notes[-1].text == f"no reply: {table.robot.why_no_geometry}"
    assert "mypalletizer_260_m5.urdf" in table.robot.geometry_unknown
