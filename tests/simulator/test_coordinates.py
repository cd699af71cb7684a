"""Test the end of the simulated arm: targets, straight lines, jogs, and reference frames."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE, TargetKind
from cobotwire.kinematics import Pose
from cobotwire.protocol.robot import UNSTATED
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from simulator.bench import Bench

REFERENCE = codecs.load(TABLE, "reference")
BENT = (10.0, -30.0, -60.0, 20.0, 5.0, 30.0)
# How far the rounding of six joints to ticks may move the end, in millimetres.
TICKS = 0.8
LINEAR, FORWARD, BACKWARD = 1, 1, 0


class BentBench(Bench):
    """A powered, bent arm."""

    def __init__(self) -> None:
        super().__init__(TABLE)
        self.send("send_angles", BENT, 100)
        self.clock.sleep(10)

    @property
    def end(self) -> Pose:
        return Pose.of(self.query("get_coords"))


@pytest.fixture
def bench() -> BentBench:
    return BentBench()


def shifted(coords: tuple[float, ...], *shift: float) -> tuple[float, ...]:
    return tuple(round(a + b, 2) for a, b in zip(coords, (*shift, 0, 0, 0, 0, 0, 0)))


def test_linear_motion_is_straight(bench: BentBench) -> None:
    start = bench.query("get_coords")
    target = shifted(start, -60, 40, -50)
    bench.send("send_coords", target, 60, LINEAR)
    off = []
    while bench.query("is_moving"):
        here = bench.query("get_coords")
        share = (here[0] - start[0]) / -60
        off += [abs(here[1] - start[1] - 40 * share), abs(here[2] - start[2] + 50 * share)]
        bench.clock.sleep(0.05)
    assert len(off) > 10
    assert max(off) < 2 * TICKS
    assert bench.query("is_in_position", target, TargetKind.COORDS) == 1


def test_angular_motion_is_not_straight(bench: BentBench) -> None:
    start = bench.query("get_coords")
    bench.send("send_coords", shifted(start, -120, 100, -50), 60, 0)
    off = []
    while bench.query("is_moving"):
        here = bench.query("get_coords")
        off.append(abs(here[1] - start[1] - 100 * (here[0] - start[0]) / -120))
        bench.clock.sleep(0.05)
    assert max(off) > 2


@pytest.mark.parametrize("axis", [1, 2, 3])
def test_jog_rpy_keeps_its_axis_and_the_position(bench: BentBench, axis: int) -> None:
    start = bench.end
    bench.send("jog_rpy", axis, FORWARD, 20)
    bench.clock.sleep(0.7)
    bench.send("stop")
    bench.clock.sleep(1)
    end = bench.end
    assert start.distance(end)[0] < 2 * TICKS
    assert start.distance(end)[1] > 1
    row = [part[axis - 1] for part in start[:3]]
    assert [part[axis - 1] for part in end[:3]] == pytest.approx(row, abs=0.01)


def test_tool_and_world_references_apply_when_they_are_chosen(bench: BentBench) -> None:
    flange = bench.end
    tool, world = (0, 0, 50, 10, 20, 30), (100, -40, 20, 0, 0, 90)
    bench.send("set_tool_reference", tool)
    bench.send("set_world_reference", world)
    assert bench.end == flange, "they are set, not chosen"
    bench.send("set_end_type", 1)
    x, y, z = (p + 50 * axis for p, axis in zip(flange.origin, flange.z))
    assert bench.end.origin == pytest.approx((x, y, z), abs=0.3)
    bench.send("set_reference_frame", 1)
    # In the world frame the pedestal is turned by 90 degrees: its x points along the world's y.
    assert bench.end.origin == pytest.approx((100 - y, -40 + x, 20 + z), abs=0.3)
    target = shifted(bench.query("get_coords"), 15, -20, -10)
    bench.send("send_coords", target, 60, LINEAR)
    bench.clock.sleep(10)
    assert bench.end.distance(Pose.of(target))[0] < TICKS
    bench.send("set_reference_frame", 0)
    bench.send("set_end_type", 0)
    # The same motion of the flange, in the frame of the base: 15 along the world's x is -y.
    expected = [a + b for a, b in zip(flange.origin, (-20, -15, -10))]
    assert bench.end.origin == pytest.approx(expected, abs=2 * TICKS)


def test_kinematics_commands_agree_with_the_arm(bench: BentBench) -> None:
    coords = bench.query("get_coords")
    standing = bench.arm.state.standing(bench.clock())
    assert bench.query("angles_to_coords", bench.query("get_angles")) == pytest.approx(
        coords, abs=0.3
    )
    solved = bench.query("solve_inv_kinematics", coords, bench.query("get_angles"))
    assert solved == pytest.approx(standing, abs=0.2)
    given = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    assert bench.query("solve_inv_kinematics", (0, 0, 3000, 0, 0, 0), given) == given
    assert bench.query("get_error_information") == 32


def test_arm_outside_its_limits_stays_there_until_it_is_sent_inside(
    bench: BentBench,
) -> None:
    bench.arm.state.angles.place((88.1, -148.33, 140.4, -140.0, 104.2, -13.7), bench.clock())
    assert bench.query("get_angles")[1] == -148.35
    bench.send("send_angle", 1, 20.0, 100)
    bench.clock.sleep(5)
    assert bench.query("get_angles")[:2] == (20.03, -148.35)
    bench.send("jog_angle", 2, BACKWARD, 50)
    bench.clock.sleep(5)
    assert bench.query("get_angles")[1] == -148.35
    bench.send("jog_angle", 2, FORWARD, 50)
    bench.clock.sleep(0.5)
    assert bench.query("get_angles")[1] > -148.35


def test_arm_without_stated_facts_moves_joints_and_rejects_coordinates() -> None:
    clock = SteppedClock()
    arm = SimulatedArm(TABLE._replace(robot=UNSTATED), clock=clock)

    def query(name: str, *values: Any) -> Any:
        reply = arm.receive(REFERENCE.encode(name, "request", values))
        return REFERENCE.decode("reply", reply, of=name).values[-1]

    query("power_on")
    query("send_angles", (10.0, 20.0, 30.0, 40.0, 50.0, 60.0), 100)
    clock.sleep(5)
    assert query("get_angles") == (10.0, 20.0, 30.0, 40.0, 50.0, 60.0), "no rounding to ticks"
    why = "the geometry of this arm is not known"
    for silent in (
        ("get_coords",),
        ("angles_to_coords", BENT),
        ("solve_inv_kinematics", (100, 0, 200, 0, 0, 0), BENT),
        ("is_in_position", (0,) * 6, TargetKind.COORDS),
    ):
        line = f"simulated arm: {why}\r\n".encode()
        assert arm.receive(REFERENCE.encode(silent[0], "request", silent[1:])) == line
        assert arm.notes[-1].text == f"no reply: {why}"
    for motion in (("send_coords", (100, 0, 200, 0, 0, 0), 50, 0), ("jog_coord", 1, 1, 50)):
        acknowledgement = REFERENCE.encode(motion[0], "reply", (1,))
        # A text before it would keep the maker's library from reading it.
        assert arm.receive(REFERENCE.encode(motion[0], "request", motion[1:])) == acknowledgement
        assert (arm.notes[-1].command, arm.notes[-1].text) == (motion[0], f"rejected: {why}")
    assert query("is_moving") == 0
