"""An arm with its own number of joints, names and order of arguments moves and is waited for.

``test_waiting.py`` moves the arm of every edition.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cobotwire import Limits, ReplyTimeout, UsageError
from cobotwire.protocol.limits import limited
from cobotwire.session.motion import Goal, goal_of
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire_codegen.errors import SpecError
from trial_specs import FOOTED, HEAD, edition_of, package_of

SPEC = f"""
{HEAD}
joints: 4
{FOOTED}
types:
  wire:
    byte: {{bytes: 1, doc: A byte.}}
    word: {{bytes: 2, signed_at: 32767, doc: A signed word.}}
  quantities:
    joint: {{wire: byte, range: [1, 4], doc: A joint.}}
    angle: {{wire: word, scale: 1/100, unit: degree, range: [-170, 170], doc: An angle.}}
    length: {{wire: word, scale: 1/10, unit: millimetre, doc: A length.}}
    percent: {{wire: byte, range: [1, 100], unit: percent, doc: A speed.}}
  values:
    angles: {{class: Pose, doc: The angles., items: {{j1: angle, j2: angle, j3: angle, j4: angle}}}}
    coordinates:
      {{class: Place, doc: The coordinates., items: {{x: length, y: length, z: length, rx: angle}}}}
commands:
  switch_on: {{id: 0x10, title: Switch on, doc: Switches on., safety: power}}
  read_joints:
    {{id: 0x20, title: Joints, doc: Joints., safety: query, role: joints,
     reply: [{{name: pose, type: angles}}]}}
  turn_joint:
    {{id: 0x21, title: Turn, doc: Turns a joint., safety: motion, role: joint target, request: [
      {{name: pace, type: percent}}, {{name: angle, type: angle}}, {{name: which, type: joint}}]}}
  turn_joints:
    {{id: 0x22, title: Turn all, doc: Turns all., safety: motion, role: joint targets, request: [
      {{name: pace, type: percent}}, {{name: pose, type: angles}}]}}
  read_place:
    {{id: 0x23, title: Place, doc: Place., safety: query, role: coordinates,
     reply: [{{name: place, type: coordinates}}]}}
  go_to_place:
    {{id: 0x25, title: Go, doc: Goes., safety: motion, role: coordinate targets, request: [
      {{name: pace, type: percent}}, {{name: place, type: coordinates}}]}}
  halt: {{id: 0x29, title: Halt, doc: Halts., safety: motion, role: stop}}
"""


KINDS = """
  flags:
    flag: {wire: byte, doc: Yes or no.}
  enums:
    kind:
      class: Kind
      wire: byte
      doc: What a target is.
      members: {COORDS: {value: 0, doc: C.}, ANGLES: {value: 1, doc: A.}}
  values:"""
REACHED = """
  is_there:
    {id: 0x2A, title: Reached, doc: Whether it is there., safety: query, role: reached,
     request: [{name: sort, type: kind}, {name: target, type: angles}],
     reply: [{name: there, type: flag}]}
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Yield the package of the arm."""
    with package_of(SPEC, tmp_path_factory.mktemp("arm")) as made:
        yield made


def powered(package: Any) -> tuple[Any, SimulatedArm]:
    """Return a client in stepped time, and its arm, which has power."""
    clock = SteppedClock()
    simulated = SimulatedArm(package.TABLE, clock=clock, powered=True)
    return package.CLIENT(MemoryTransport(simulated, clock)), simulated


def test_arm_with_its_own_order_of_arguments_moves_and_is_waited_for(package: Any) -> None:
    arm, _ = powered(package)
    arm.move_angles([10.0, 20.0, 30.0, 40.0], 50)
    assert arm.read_joints() == pytest.approx([10.0, 20.0, 30.0, 40.0], abs=0.5)
    arm.turn_joint(50, 5.0, 2)
    arm.wait_until_reached([10.0, 5.0, 30.0, 40.0], kind=0)


def test_kind_of_a_target_has_the_number_that_its_edition_states(tmp_path: Path) -> None:
    with package_of(SPEC.replace("\n  values:", KINDS) + REACHED, tmp_path) as package:
        arm, _ = powered(package)
        arm.move_angles([10.0, 20.0, 30.0, 40.0], 50)
        arm.wait_until_reached([10.0, 20.0, 30.0, 40.0], kind=package.Kind.ANGLES)


def test_arm_moves_as_its_edition_states(tmp_path: Path) -> None:
    stated = "motion: {speed: 10, fastest: 400, acceleration: 100000, doc: Fast.}\nframe:"
    with package_of(SPEC.replace("frame:", stated, 1), tmp_path) as package:
        assert package.TABLE.robot.motion[:3] == (10.0, 400.0, 100000.0)
        clock = SteppedClock()
        simulated = SimulatedArm(package.TABLE, clock=clock, powered=True)
        arm = package.Trial(MemoryTransport(simulated, clock))
        arm.turn_joints(30, [150.0, 0.0, 0.0, 0.0])
        clock.sleep(0.25)
        assert arm.read_joints()[0] == pytest.approx(75.0, abs=5)
        arm.turn_joints(100, [0.0, 0.0, 0.0, 0.0])
        clock.sleep(0.25 + 0.2)
        assert arm.read_joints()[0] == pytest.approx(70.0, abs=5)


def test_motion_at_speed_0_is_reported(tmp_path: Path) -> None:
    stated = "motion: {speed: 0, fastest: 400, acceleration: 100, doc: None.}\nframe:"
    with pytest.raises(SpecError, match="must be above 0"):
        edition_of(SPEC.replace("frame:", stated, 1), tmp_path)


def test_coordinates_without_geometry_have_no_reply(package: Any) -> None:
    arm, simulated = powered(package)
    with pytest.raises(ReplyTimeout):
        arm.read_place()
    assert "geometry" in simulated.notes[-1].text
    stream = arm.stream(package.ReadPlace(), rate=10)
    with pytest.raises(ReplyTimeout, match="because the arm is simulated"):
        next(stream)


def test_limits_find_the_targets_in_any_order(package: Any) -> None:
    narrow = Limits([(-5.0, 5.0), None, None, None])
    table = limited(package.TABLE, narrow)
    assert table.in_role("joint target").request[0].fields[1].selector == 2
    arm = package.CLIENT(MemoryTransport(SimulatedArm(package.TABLE)), limits=narrow)
    with pytest.raises(UsageError, match="5"):
        arm.turn_joint(50, 6.0, 1)
    with pytest.raises(UsageError, match="5"):
        arm.move_angles([6.0] * 4, 50)
    arm.turn_joint(50, 6.0, 2)


def test_target_with_a_wrong_number_of_values_is_rejected_before_it_is_sent(package: Any) -> None:
    arm, _ = powered(package)
    with pytest.raises(UsageError):
        arm.move_angles([0.0] * 5, 50)
    with pytest.raises(UsageError, match="kind"):
        arm.wait_until_reached([0.0] * 4, kind=7)


def test_orientation_is_compared_across_half_a_turn(package: Any) -> None:
    goal = goal_of(package.TABLE, [100.0, 0.0, 50.0, 170.0], 1)
    assert isinstance(goal, Goal)
    assert goal.is_met([96.0, 4.0, 50.0, -190.3])
    assert goal.is_met([95.0, 0.0, 50.0, 170.0]), "the tolerance itself is within it"
    assert not goal.is_met([100.0, 0.0, 50.0, -170.0])
    assert not goal.is_met([94.0, 0.0, 50.0, 170.0])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("{name: pace, type: percent}, {name: pose, type: angles}", "{name: pose, type: angles}"),
        ("{name: which, type: joint}", "{name: which, type: angle}"),
        ("reply: [{name: place, type: coordinates}]", "reply: [{name: place, type: length}]"),
    ],
)
def test_command_that_lacks_what_its_role_needs_is_reported(
    tmp_path: Path, old: str, new: str
) -> None:
    assert old in SPEC
    _, problems = edition_of(SPEC.replace(old, new), tmp_path)
    assert "bad-role" in {problem.code for problem in problems}
