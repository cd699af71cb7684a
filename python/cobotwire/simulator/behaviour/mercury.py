"""What the Mercury and the Pro arms do for commands that the 280 lacks, or that have other fields.

Their frames end with a CRC, and they report the end of each motion. The types are those of the
Mercury A1; the other editions have messages with the same fields.
"""

from __future__ import annotations

from cobotwire.editions.mercury_a1 import messages as m
from cobotwire.editions.mercury_b1.messages import GetBaseCoords, IsInPositionBaseCoords
from cobotwire.editions.pro450.messages import SetMotorEnabled
from cobotwire.simulator.behaviour.registry import (
    Behaviours,
    Unanswerable,
    family,
    known,
    row,
)
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angle, go_to_angles, go_to_coords, may_move

# The group of errors of motions, as get_error_information reports it, and the status of a start.
MOTION_ERRORS, STARTED = 0xD0, 1
# Turns per minute of one degree per second.
RPM = 60 / 360

MERCURY = family("mercury_a1", Behaviours())


@MERCURY.behaviour(m.PowerOn)
def power_on(arm: ArmState, now: float, request: m.PowerOn) -> m.PowerOnReply:
    """Power the arm; with mode 1, hold every joint where it is."""
    led = arm.released
    arm.power_on()
    if not request.mode:
        arm.enabled = [False] * arm.joints
    elif led:
        arm.hold(now)
    return m.PowerOnReply(status=STARTED)


@MERCURY.behaviour(m.PowerOnOnly)
def power_on_only(arm: ArmState, now: float, request: m.PowerOnOnly) -> None:
    """Power the arm, but hold no joint."""
    arm.power_on()
    arm.enabled = [False] * arm.joints


@MERCURY.behaviour(SetMotorEnabled)
def set_motor_enabled(arm: ArmState, now: float, request: SetMotorEnabled) -> None:
    """Hold or release one joint; a number above the joints' is every joint."""
    every = request.joint > arm.joints
    joints = range(arm.joints) if every else [request.joint - 1]
    led = arm.released
    for at in joints:
        arm.enabled[at] = arm.powered and bool(request.enabled)
    if not request.enabled:
        arm.release(now)
    elif led:
        arm.hold(now)


@MERCURY.behaviour(m.JogIncrementAngle)
def jog_increment_angle(arm: ArmState, now: float, request: m.JogIncrementAngle) -> None:
    """Turn a joint by a step."""
    angle = arm.angles.target(now)[request.joint - 1] + request.increment
    go_to_angle(arm, request.joint, angle, request.speed, now)


@MERCURY.behaviour(m.GetErrorInformation)
def get_error_information(
    arm: ArmState, now: float, request: m.GetErrorInformation
) -> m.GetErrorInformationReply:
    """Reply with the last error; 0: there is none."""
    return m.GetErrorInformationReply(MOTION_ERRORS if arm.error else 0, arm.error)


@MERCURY.behaviour(m.GetAngle)
def get_angle(arm: ArmState, now: float, request: m.GetAngle) -> m.GetAngleReply:
    """Reply with the angle of a joint."""
    return m.GetAngleReply(arm.reported_angles(arm.angles.position(now))[request.joint - 1])


@MERCURY.behaviour(m.SetJointMinAngle)
def set_joint_min_angle(arm: ArmState, now: float, request: m.SetJointMinAngle) -> None:
    """Set the smallest angle of a joint."""
    arm.minimum[request.joint - 1] = request.angle


@MERCURY.behaviour(m.SetJointMaxAngle)
def set_joint_max_angle(arm: ArmState, now: float, request: m.SetJointMaxAngle) -> None:
    """Set the largest angle of a joint."""
    arm.maximum[request.joint - 1] = request.angle


@MERCURY.behaviour(m.OverLimitReturnZero)
def over_limit_return_zero(arm: ArmState, now: float, request: m.OverLimitReturnZero) -> None:
    """Move every joint to zero."""
    go_to_angles(arm, (0.0,) * arm.joints, 20, now)


@MERCURY.behaviour(m.SetSolutionAngles)
def set_solution_angles(arm: ArmState, now: float, request: m.SetSolutionAngles) -> None:
    """Remember the deflection; to move the joints, the lengths of the links would be needed."""
    if may_move(arm, request.speed):
        arm.kept["solution"], arm.at_once = request.angle, True


MERCURY.query(m.GetSolutionAngles, lambda arm, now, request: arm.kept.get("solution", 0.0))


@MERCURY.behaviour(m.WriteMoveC)
def write_move_c(arm: ArmState, now: float, request: m.WriteMoveC) -> None:
    """Move the end to the end of the arc, by the joints' shortest way."""
    go_to_coords(arm, request.end, request.speed, now)


@MERCURY.behaviour(m.WriteMoveCR)
def write_move_c_r(arm: ArmState, now: float, request: m.WriteMoveCR) -> None:
    """Move the end to the end of the arc, by the joints' shortest way."""
    go_to_coords(arm, request.coords, request.speed, now)


@MERCURY.behaviour(m.GetServoSpeeds)
def get_servo_speeds(arm: ArmState, now: float, request: m.GetServoSpeeds) -> m.GetServoSpeedsReply:
    """Reply with the speed of each joint in turns per minute."""
    return m.GetServoSpeedsReply(row(round(v * RPM, 2) for v in arm.angles.speed(now)))


@MERCURY.behaviour(m.GetRobotStatus)
def get_robot_status(arm: ArmState, now: float, request: m.GetRobotStatus) -> m.GetRobotStatusReply:
    """Reply with what moves, and which joints are beyond their limits; no motor has an error."""
    angles = arm.angles.position(now)
    beyond = (not low <= at <= high for at, low, high in zip(angles, arm.minimum, arm.maximum))
    none = row([0] * arm.joints)
    moving = arm.angles.moving(now) and not arm.released
    return m.GetRobotStatusReply(False, moving, row(map(int, beyond)), none, none)


@MERCURY.behaviour(m.GetQuickMoveInfo)
def get_quick_move_info(
    arm: ArmState, now: float, request: m.GetQuickMoveInfo
) -> m.GetQuickMoveInfoReply:
    """Reply with angles and coordinates; nobody knows what the further bytes are."""
    angles = arm.standing(now)
    coords = row(known(arm.reported_coords(angles)))
    return m.GetQuickMoveInfoReply(row(arm.reported_angles(angles)), coords, row([0] * 8))


@MERCURY.behaviour(GetBaseCoords)
def get_base_coords(arm: ArmState, now: float, request: GetBaseCoords) -> None:
    """Reply nothing: no source states where the arm is mounted on the body."""
    raise Unanswerable


@MERCURY.behaviour(IsInPositionBaseCoords)
def is_in_position_base_coords(arm: ArmState, now: float, request: IsInPositionBaseCoords) -> None:
    """Reply nothing: no source states where the arm is mounted on the body."""
    raise Unanswerable
