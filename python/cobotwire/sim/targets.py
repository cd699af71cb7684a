"""Targets: what becomes of them, and why an arm does not go where it was sent.

An order that the arm does not obey is answered as any other; the real arm does not tell either. The
reason is remarked, and is the error that newer firmware reports where it has a number.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from cobotwire.sim.kinematics import Pose, nearest
from cobotwire.sim.kinematics.straight import line
from cobotwire.sim.kinematics.ticks import on_tick
from cobotwire.sim.state import DEGREES_A_SECOND, FASTEST, ArmState

# Numbers of get_error_information: 1 to 6 are joints beyond their limits.
NO_SOLUTION, NO_STRAIGHT_WAY = 32, 33
# A straight way is worked out at places that are no further apart.
STEP_MILLIMETRES, STEP_DEGREES = 5.0, 2.0
# A joint that would turn further than this from one such place to the next one cannot follow.
FOLLOWS = 30.0

Point = tuple[float, ...]


def rate(speed: int) -> float:
    """Degrees a second at a speed in percent."""
    return min(DEGREES_A_SECOND * speed, FASTEST)


def refuse(arm: ArmState, why: str, error: int = 0) -> bool:
    """Remark why an order is not obeyed; always False."""
    arm.remarks.append(why)
    arm.settings.error = error or arm.settings.error
    return False


def may_move(arm: ArmState, speed: int) -> bool:
    """Whether a motion is obeyed now: powered, held, not stopped, and at any speed."""
    if not arm.powered:
        return refuse(arm, "ignored: the arm has no power")
    if arm.free or not all(arm.enabled):
        return refuse(arm, "ignored: not every joint is held")
    if arm.stopped:
        return refuse(arm, "ignored: the arm was stopped, and waits for resume")
    if speed == 0:
        return refuse(arm, "ignored: its speed is 0")
    return True


def go_to_angles(
    arm: ArmState, target: Point, speed: int, now: float, *, queue: bool | None = None
) -> bool:
    """Send the joints to angles, each to the nearest tick inside its limits.

    Args:
        arm: the arm.
        target: the angles in degrees.
        speed: percent, 1..100.
        now: the time.
        queue: whether it goes behind what is under way; left out: as the arm's mode says.
    """
    if not may_move(arm, speed):
        return False
    present, goal = arm.angles.target(now), []
    for joint, (low, high) in enumerate(arm.limits()):
        wish = target[joint]
        # A joint that stays may be outside: an arm at rest was seen beyond its limits.
        if wish != present[joint]:
            if low > high or not arm.minimum[joint] <= wish <= arm.maximum[joint]:
                why = f"refused: joint {joint + 1} is not to go to {wish:.2f} degrees"
                return refuse(arm, f"{why}, beyond its limits", joint + 1)
            wish = min(max(on_tick(wish) if arm.geometry else wish, low), high)
        goal.append(wish)
    arm.angles.go(goal, rate(speed), now, queue=_queues(arm) if queue is None else queue)
    _mind_the_pause(arm)
    return True


def go_to_coords(
    arm: ArmState, target: Iterable[float], speed: int, now: float, *, straight: bool = False
) -> bool:
    """Send the end to coordinates, over the joints' shortest way or a straight line."""
    if not may_move(arm, speed):
        return False
    if arm.geometry is None:
        return refuse(arm, "refused: the geometry of this arm is not known")
    end = Pose.of(tuple(target))
    start = arm.angles.target(now) if _queues(arm) else arm.angles.stop_at(now)
    goal = solve(arm, end, start)
    if goal is None:
        return False
    if not straight:
        return go_to_angles(arm, goal, speed, now)
    here = arm.end(start)
    points = [] if here is None else _follow(arm, line(here, end, _steps(here, end)), start)
    if not points:
        return refuse(arm, "refused: no straight way leads there", NO_STRAIGHT_WAY)
    _go_along(arm, points, speed, now, queue=_queues(arm))
    return True


def jog(
    arm: ArmState, way: Callable[[Pose, float], Pose], step: float, speed: int, now: float
) -> bool:
    """Move the end until it is stopped, a joint is at its limit, or nothing is in reach.

    Args:
        arm: the arm.
        way: where the end is after so many steps, seen from where it is now.
        step: how much of the way one step is; up to one turn, or what no arm reaches.
        speed: percent, 1..100.
        now: the time.
    """
    if not may_move(arm, speed):
        return False
    start = arm.angles.stop_at(now)
    here = arm.end(start)
    if here is None:
        return refuse(arm, "refused: the geometry of this arm is not known")
    points = _follow(
        arm, (way(here, step * n) for n in range(1, JOG_STEPS)), start, all_of_it=False
    )
    if not points:
        return refuse(arm, "refused: no way leads on in this direction", NO_SOLUTION)
    _go_along(arm, points, speed, now, queue=False)
    return True


# One turn in steps of two degrees; in steps of five millimetres it leads out of any reach.
JOG_STEPS = 181


def solve(arm: ArmState, end: Pose, start: Point) -> Point | None:
    """The angles nearest to ``start`` that bring the end there; None, with a remark: none do."""
    assert arm.geometry is not None, "the caller has asked"
    try:
        found = nearest(arm.geometry, arm.flange_for(end), start, arm.limits())
    except ImportError:
        what = "refused: out of reach, as far as can be told without SciPy"
        refuse(arm, f"{what} (pip install 'cobotwire[sim]')", NO_SOLUTION)
        return None
    if found is None:
        told = ", ".join(f"{value:.2f}" for value in end.coords)
        refuse(arm, f"refused: no joint angles reach ({told})", NO_SOLUTION)
    return found


def _follow(
    arm: ArmState, ends: Iterable[Pose], start: Point, *, all_of_it: bool = True
) -> list[Point]:
    """The angles along a way; where it cannot be gone on, what there is until then, or nothing."""
    assert arm.geometry is not None, "the caller has asked"
    limits, points = arm.limits(), [start]
    for end in ends:
        try:
            found = nearest(arm.geometry, arm.flange_for(end), points[-1], limits)
        except ImportError:
            found = None
        if found is None or max(abs(a - b) for a, b in zip(found, points[-1])) > FOLLOWS:
            return [] if all_of_it else points[1:]
        points.append(found)
    return points[1:]


def _go_along(arm: ArmState, points: list[Point], speed: int, now: float, *, queue: bool) -> None:
    """Follow points; the last one is put on ticks, where servos can stand."""
    goal = tuple(
        min(max(on_tick(angle), low), high) for angle, (low, high) in zip(points[-1], arm.limits())
    )
    arm.angles.follow([*points[:-1], goal], rate(speed), now, queue=queue)
    _mind_the_pause(arm)


def _mind_the_pause(arm: ArmState) -> None:
    """No answer tells that an order has to wait."""
    if arm.paused:
        arm.remarks.append("waits: the arm is paused until resume")


def _steps(start: Pose, end: Pose) -> int:
    way, turn = start.distance(end)
    return max(math.ceil(way / STEP_MILLIMETRES), math.ceil(turn / STEP_DEGREES), 1)


def _queues(arm: ArmState) -> bool:
    return arm.fresh_mode == 0
