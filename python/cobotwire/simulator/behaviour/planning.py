"""Motion and kinematics of newer firmware, and where a motion will end."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.motion import moves_straight
from cobotwire.simulator.behaviour.registry import Unanswerable, behaviour, known, query, row
from cobotwire.simulator.coordinates import pose_with
from cobotwire.simulator.kinematics import Effort
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_coords, go_to_encoders, is_there, solve

# The speed at which the simulated arm moves to each recorded point, in percent.
DRAG_SPEED = 50


@behaviour(m.ClearQueue)
def clear_queue(arm: ArmState, now: float, request: m.ClearQueue) -> None:
    """Forget the waiting targets. The sources define no more, so the present motion continues."""
    arm.angles.forget(now)


query(m.GetAnglesPlan, lambda arm, now, request: row(arm.reported_angles(arm.angles.target(now))))
# In the frame of the base.
query(
    m.GetCoordsPlan,
    lambda arm, now, request: row(known(arm.reported_coords(arm.angles.target(now), base=True))),
)


@behaviour(m.GetAnglesCoords)
def get_angles_coords(
    arm: ArmState, now: float, request: m.GetAnglesCoords
) -> m.GetAnglesCoordsReply:
    """Reply with the angles of the joints and the end's coordinates."""
    standing = arm.standing(now)
    coords = known(arm.reported_coords(standing))
    return m.GetAnglesCoordsReply(angles=row(arm.reported_angles(standing)), coords=row(coords))


# In the frame and for the end type that are set. Joints rest on ticks, so the reply for the angles
# of get_angles equals that of get_coords.
query(
    m.AnglesToCoords,
    lambda arm, now, request: row(known(arm.reported_coords(arm.on_ticks(tuple(request.angles))))),
)


@behaviour(m.SolveInvKinematics)
def solve_inv_kinematics(
    arm: ArmState, now: float, request: m.SolveInvKinematics
) -> m.SolveInvKinematicsReply:
    """Reply with angles for an end, near the given angles.

    No source defines the reply without a solution; this arm returns the given angles and sets an
    error.
    """
    if arm.geometry is None:
        raise Unanswerable
    near = tuple(request.angles)
    if is_there(arm, tuple(request.coords), near):
        return m.SolveInvKinematicsReply(angles=row(near))
    found = solve(arm, arm.pose_of(request.coords, near), near, Effort())
    return m.SolveInvKinematicsReply(angles=row(near if found is None else found))


@behaviour(m.JogIncrementCoord)
def jog_increment_coord(arm: ArmState, now: float, request: m.JogIncrementCoord) -> None:
    """Move the end along or about an axis by a step from its target."""
    end, place = arm.end(arm.angles.target(now)), arm.coordinates[request.axis - 1]
    present = end.coords[place] if end else 0.0
    target = pose_with((present + request.increment,), (place,), end)
    go_to_coords(arm, target, request.speed, now, straight=moves_straight(arm))


@behaviour(m.SetEncodersDrag)
def set_encoders_drag(arm: ArmState, now: float, request: m.SetEncodersDrag) -> None:
    """Move all servos to a recorded point."""
    speed = DRAG_SPEED if any(request.speeds) else 0
    go_to_encoders(arm, dict(enumerate(request.encoders)), speed, now)


@behaviour(m.MoveRound)
def move_round(arm: ArmState, now: float, request: m.MoveRound) -> None:
    """Do not move: no source describes the motion."""
    arm.remarks.append("ignored: no source says how the arm moves")


@behaviour(m.FocusAllServos)
def focus_all_servos(arm: ArmState, now: float, request: m.FocusAllServos) -> None:
    """Hold every joint."""
    led, arm.enabled = arm.released, [arm.powered] * arm.joints
    if led:
        arm.hold(now)
