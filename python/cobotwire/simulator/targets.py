"""Targets: how the arm moves to them, and when it rejects them.

A command that the arm rejects or ignores is acknowledged like any other, because the real arm does
not report it either. The reason becomes a note; newer firmware reports its number as the last
error.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping

from cobotwire.kinematics import Effort, Pose, nearest
from cobotwire.kinematics.descent import STEPS_OF_A_REQUEST
from cobotwire.kinematics.straight import angles_along, steps_between, straight_line
from cobotwire.simulator.replies import Unanswerable
from cobotwire.simulator.state import ArmState

# Enough for a full turn in steps of three degrees, and beyond any reach in steps of seven
# millimetres.
JOG_STEPS = 121

# Reported numbers that differ by less are the same: it is far below the wire's steps.
SAME = 1e-6

Point = tuple[float, ...]


def rate(arm: ArmState, speed: int) -> float:
    """Return degrees per second for a speed in percent."""
    return min(arm.motion.speed * speed, arm.motion.fastest)


def reject(arm: ArmState, why: str, error: int = 0) -> bool:
    """Note why a command is rejected or ignored; return False."""
    arm.remarks.append(why)
    arm.error = error or arm.error
    arm.rejection = error
    return False


def may_move(arm: ArmState, speed: int) -> bool:
    """Return whether the arm obeys a motion now: it is powered and held."""
    if not arm.powered:
        return reject(arm, "ignored: the arm has no power")
    if arm.free or not all(arm.enabled):
        return reject(arm, "ignored: not every joint is held")
    if speed == 0:
        return reject(arm, "ignored: its speed is 0")
    return True


def go_to_angles(
    arm: ArmState, target: Point, speed: int, now: float, *, queue: bool | None = None
) -> bool:
    """Move the joints to angles, each to the nearest tick inside its limits.

    Args:
        arm: the arm.
        target: the angles in degrees.
        speed: percent, 1..100.
        now: the time.
        queue: whether the present motion ends first; None: the arm's mode decides.

    Returns:
        Whether the arm obeys.
    """
    if not may_move(arm, speed):
        return False
    present, goal = arm.angles.target(now), []
    for joint, (low, high) in enumerate(arm.limits()):
        wish = target[joint]
        # A joint that does not move may be outside: an arm at rest was seen beyond its limits.
        if wish != present[joint]:
            if low > high or not arm.minimum[joint] <= wish <= arm.maximum[joint]:
                why = f"rejected: {wish:.2f} degrees is beyond the limits of joint {joint + 1}"
                return reject(arm, why, arm.error_codes.joint_limits[joint])
            wish = min(max(arm.on_tick(wish), low), high)
        goal.append(wish)
    arm.angles.go(goal, rate(arm, speed), now, queue=arm.queues if queue is None else queue)
    # A motion also starts if the arm is there already; it then takes no time.
    arm.at_once = True
    _note_a_pause(arm)
    return True


def go_to_angle(arm: ArmState, joint: int, angle: float, speed: int, now: float) -> bool:
    """Move one joint, counted from 1; return whether the arm obeys."""
    target = list(arm.angles.target(now))
    target[joint - 1] = angle
    return go_to_angles(arm, tuple(target), speed, now)


def go_to_encoders(arm: ArmState, readings: Mapping[int, int], speed: int, now: float) -> bool:
    """Move joints, counted from 0, to readings of their encoders; return whether the arm obeys."""
    if arm.encoders is None:
        return reject(arm, "rejected: the encoders of this arm are not known")
    target = list(arm.angles.target(now))
    for joint, reading in readings.items():
        target[joint] = arm.encoders.angle(joint, reading)
    return go_to_angles(arm, tuple(target), speed, now)


def move_gripper(arm: ArmState, value: float, speed: int, now: float) -> None:
    """Move the gripper to an opening in percent. Like the joints, it needs power to move."""
    if arm.powered and speed > 0:
        arm.gripper.go((float(value),), arm.gripper_facts.speed * speed, now)
    else:
        arm.remarks.append("ignored: the gripper has no power, or its speed is 0")


def go_to_coords(
    arm: ArmState,
    target: Pose | Iterable[float],
    speed: int,
    now: float,
    *,
    straight: bool = False,
) -> bool:
    """Move the end to coordinates, by the joints' shortest way or on a straight line.

    ``target`` is the end's pose, or the coordinates that the edition has.
    Return whether the arm obeys.
    """
    if not may_move(arm, speed):
        return False
    if arm.geometry is None:
        raise Unanswerable
    start = arm.angles.target(now) if arm.queues else arm.angles.stop_at(now)
    if not isinstance(target, Pose):
        target = tuple(target)
        if is_there(arm, target, start):
            return go_to_angles(arm, start, speed, now)
    end = target if isinstance(target, Pose) else arm.pose_of(target, start)
    effort = Effort()
    goal = solve(arm, end, start, effort)
    if goal is None:
        return False
    if not straight:
        return go_to_angles(arm, goal, speed, now)
    here = arm.end(start)
    assert here is not None, "the geometry is known"
    steps = steps_between(here, end)
    points = _follow(arm, straight_line(here, end, steps), start, effort)
    if len(points) < steps:
        why = f"rejected: the joints cannot follow a straight line{_ended(effort)}"
        return reject(arm, why, arm.error_codes.no_straight_line)
    _go_along(arm, points, speed, now, queue=arm.queues)
    return True


def jog(
    arm: ArmState, way: Callable[[Pose, float], Pose], step: float, speed: int, now: float
) -> bool:
    """Move the end until it is stopped, a joint is at its limit, or the end cannot reach further.

    Args:
        arm: the arm.
        way: returns the pose at a distance, in millimetres or degrees, from a pose.
        step: the distance between two points, in millimetres or degrees.
        speed: percent, 1..100.
        now: the time.

    Returns:
        Whether the arm obeys.
    """
    if not may_move(arm, speed):
        return False
    start = arm.angles.stop_at(now)
    here = arm.end(start)
    if here is None:
        raise Unanswerable
    effort = Effort()
    ends = (way(here, step * n) for n in range(1, JOG_STEPS))
    points = _follow(arm, ends, start, effort)
    if not points:
        why = f"rejected: the end cannot move in this direction{_ended(effort)}"
        return reject(arm, why, arm.error_codes.no_solution)
    if not effort.left:
        arm.remarks.append(f"ends early: no joint angles were found further on{_ended(effort)}")
    _go_along(arm, points, speed, now, queue=False)
    return True


def is_there(arm: ArmState, coords: Point, angles: Point) -> bool:
    """Return whether coordinates are those that the arm reports at ``angles``.

    Then ``angles`` are the nearest solution. The coordinates are rounded, so calculating could
    find others, far away where the elbow or the wrist is straight, or beyond a limit.
    """
    reported = arm.reported_coords(arm.on_ticks(angles))
    return reported is not None and all(
        math.isclose(one, other, abs_tol=SAME) for one, other in zip(reported, coords)
    )


def solve(arm: ArmState, end: Pose, start: Point, effort: Effort) -> Point | None:
    """Return the angles nearest to ``start`` that bring the end there; else None, with a note."""
    assert arm.geometry is not None, "the caller has checked this"
    found = nearest(arm.geometry, arm.flange_for(end), start, arm.limits(), effort=effort)
    if found is None:
        coords = ", ".join(f"{value:.2f}" for value in end.coords)
        why = f"rejected: no joint angles reach ({coords}){_ended(effort)}"
        reject(arm, why, arm.error_codes.no_solution)
    return found


def _ended(effort: Effort) -> str:
    """Return what to add to a reason if the search has used up its effort."""
    return "" if effort.left else f"; the search ended after {STEPS_OF_A_REQUEST} steps"


def _follow(arm: ArmState, ends: Iterable[Pose], start: Point, effort: Effort) -> list[Point]:
    """Return the angles along a path, as far as the joints can follow."""
    assert arm.geometry is not None, "the caller has checked this"
    return angles_along(arm.geometry, map(arm.flange_for, ends), start, arm.limits(), effort)


def _go_along(arm: ArmState, points: list[Point], speed: int, now: float, *, queue: bool) -> None:
    """Follow points; the last one is on ticks, where servos stop."""
    goal = tuple(
        min(max(arm.on_tick(angle), low), high)
        for angle, (low, high) in zip(points[-1], arm.limits())
    )
    arm.angles.follow([*points[:-1], goal], rate(arm, speed), now, queue=queue)
    _note_a_pause(arm)


def _note_a_pause(arm: ArmState) -> None:
    """Note that a motion has to wait: no reply reports it."""
    if arm.paused:
        arm.remarks.append("waits: the arm is paused until resume")
