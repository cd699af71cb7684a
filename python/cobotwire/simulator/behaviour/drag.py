"""Record a motion that is led by hand."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.registry import behaviour, row
from cobotwire.simulator.state import MOST_POINTS, ArmState


@behaviour(m.DragStartRecord)
def drag_start_record(
    arm: ArmState, now: float, request: m.DragStartRecord
) -> m.DragStartRecordReply:
    """Begin to record; reply with the number of points."""
    arm.played = arm.played if arm.points else 0
    arm.recording = True
    arm.record_at = now
    arm.record(now)
    return m.DragStartRecordReply(points=len(arm.points))


@behaviour(m.DragEndRecord)
def drag_end_record(arm: ArmState, now: float, request: m.DragEndRecord) -> m.DragEndRecordReply:
    """End the recording; reply with the number of points."""
    if arm.recording and len(arm.points) < MOST_POINTS:
        arm.record_point(now)
    arm.recording = False
    return m.DragEndRecordReply(points=len(arm.points))


@behaviour(m.DragGetRecordData)
def drag_get_record_data(
    arm: ArmState, now: float, request: m.DragGetRecordData
) -> m.DragGetRecordDataReply | None:
    """Reply with the next point: each joint's encoder and speed in turn; zeros after the last."""
    if arm.played >= len(arm.points):
        arm.played = 0
        # Without a reply of the behaviour, the arm replies with zeros.
        return None
    point = arm.points[arm.played]
    arm.played += 1
    return m.DragGetRecordDataReply(point=row(point))
