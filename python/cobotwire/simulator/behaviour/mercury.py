"""What the Mercury and the Pro arms do for commands that the 280 lacks, or that have other fields.

Frames of these arms end with a CRC, and the arms report the end of each motion. The types are those
of the Mercury A1; the other editions have messages with the same fields.
"""

from __future__ import annotations

from typing import Any

from cobotwire.editions.mercury_a1 import messages as m
from cobotwire.editions.mercury_b1.messages import GetBaseCoords, IsInPositionBaseCoords
from cobotwire.simulator.behaviour.registry import Behaviours, Unanswerable, family, row
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angles, may_move

# The group of errors of motions, as get_error_information reports it.
MOTION_ERRORS = 0xD0
# The speed at which recorded points are repeated, in percent; no source states it.
REPEATED = 50

MERCURY = family("mercury_a1", Behaviours())


@MERCURY.behaviour(m.GetErrorInformation)
def get_error_information(
    arm: ArmState, now: float, request: m.GetErrorInformation
) -> m.GetErrorInformationReply:
    """Reply with the last error; 0: there is none."""
    return m.GetErrorInformationReply(MOTION_ERRORS if arm.error else 0, arm.error)


@MERCURY.behaviour(m.SetSolutionAngles)
def set_solution_angles(arm: ArmState, now: float, request: m.SetSolutionAngles) -> None:
    """Store the deflection. The joints do not move: no source states the lengths of the links."""
    if may_move(arm, request.speed):
        arm.kept["solution_angle"], arm.at_once = request.angle, True


@MERCURY.behaviour(m.GetRobotStatus)
def get_robot_status(arm: ArmState, now: float, request: m.GetRobotStatus) -> m.GetRobotStatusReply:
    """Reply with what moves, and which joints are beyond their limits; no motor has an error."""
    angles = arm.angles.position(now)
    beyond = (not low <= at <= high for at, low, high in zip(angles, arm.minimum, arm.maximum))
    none = row([0] * arm.joints)
    moving = arm.angles.moving(now) and not arm.released
    return m.GetRobotStatusReply(False, moving, row(map(int, beyond)), none, none)


def _in_base(arm: ArmState, now: float, request: Any) -> None:
    # No source states where the arm is mounted on the body.
    raise Unanswerable


for _query in (GetBaseCoords, IsInPositionBaseCoords):
    MERCURY.behaviour(_query)(_in_base)


@MERCURY.behaviour(m.DragTeachSave)
def drag_teach_save(arm: ArmState, now: float, request: m.DragTeachSave) -> None:
    """Begin a new recording; the first point is where the arm is."""
    arm.points[:] = [arm.standing(now)]


@MERCURY.behaviour(m.DragTeachPause)
def drag_teach_pause(arm: ArmState, now: float, request: m.DragTeachPause) -> None:
    """End the recording; its last point is where the arm is."""
    if arm.points:
        arm.points.append(arm.standing(now))


@MERCURY.behaviour(m.DragTeachExecute)
def drag_teach_execute(arm: ArmState, now: float, request: m.DragTeachExecute) -> None:
    """Move along the points."""
    for point in arm.points:
        go_to_angles(arm, tuple(point), REPEATED, now, queue=True)
