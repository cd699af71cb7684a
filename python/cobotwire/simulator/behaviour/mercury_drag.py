"""The points that a Mercury or a Pro arm records while it is moved by hand."""

from __future__ import annotations

from typing import Any

from cobotwire.editions.mercury_a1 import messages as m
from cobotwire.editions.mercury_a1.enums import FifoContent
from cobotwire.simulator.behaviour.mercury import MERCURY
from cobotwire.simulator.behaviour.registry import row
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angles

# The speed at which recorded points are repeated, in percent; no source states it.
REPEATED = 50
MOST_POINTS = 255


def _points(arm: ArmState) -> list[Any]:
    found: list[Any] = arm.kept.setdefault("points", [])
    return found


@MERCURY.behaviour(m.DragTeachSave)
def drag_teach_save(arm: ArmState, now: float, request: m.DragTeachSave) -> None:
    """Begin a new recording; the first point is where the arm is."""
    arm.kept["points"] = [arm.standing(now)]


@MERCURY.behaviour(m.DragTeachPause)
def drag_teach_pause(arm: ArmState, now: float, request: m.DragTeachPause) -> None:
    """End the recording; its last point is where the arm is."""
    if _points(arm):
        _points(arm).append(arm.standing(now))


@MERCURY.behaviour(m.DragTeachExecute)
def drag_teach_execute(arm: ArmState, now: float, request: m.DragTeachExecute) -> None:
    """Move along the points."""
    for point in _points(arm):
        go_to_angles(arm, tuple(point), REPEATED, now, queue=True)


@MERCURY.behaviour(m.DragTeachClean)
def drag_teach_clean(arm: ArmState, now: float, request: m.DragTeachClean) -> None:
    """Delete the points."""
    _points(arm).clear()


@MERCURY.behaviour(m.SetDragFifo)
def set_drag_fifo(arm: ArmState, now: float, request: m.SetDragFifo) -> None:
    """Add a point."""
    if len(_points(arm)) < MOST_POINTS:
        _points(arm).append(tuple(request.angles))


@MERCURY.behaviour(m.GetDragFifo)
def get_drag_fifo(arm: ArmState, now: float, request: m.GetDragFifo) -> m.GetDragFifoReply:
    """Reply with the first point and remove it; zeros if there is none."""
    points = _points(arm)
    return m.GetDragFifoReply(row(points.pop(0) if points else [0.0] * arm.joints))


MERCURY.query(m.GetDragFifoLen, lambda arm, now, request: len(_points(arm)))
MERCURY.query(m.IsDragFifoEmpty, lambda arm, now, request: FifoContent(bool(_points(arm))))
