"""Recording a motion that is done by hand."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.registry import behaviour, query, row
from cobotwire.simulator.state import MOST_POINTS, ArmState


@behaviour(m.DragStartRecord)
def drag_start_record(
    arm: ArmState, now: float, request: m.DragStartRecord
) -> m.DragStartRecordReply:
    """Begin to record; reply with the number of points."""
    arm.recording = True
    arm.record_at = now
    arm.record(now)
    return m.DragStartRecordReply(points=len(arm.recorded))


@behaviour(m.DragEndRecord)
def drag_end_record(arm: ArmState, now: float, request: m.DragEndRecord) -> m.DragEndRecordReply:
    """End the recording; reply with the number of points."""
    if arm.recording and len(arm.recorded) < MOST_POINTS:
        arm.record_point(now)
    arm.recording = False
    return m.DragEndRecordReply(points=len(arm.recorded))


query(m.DragGetRecordLen, lambda arm, now, request: len(arm.recorded))


@behaviour(m.DragClearRecordData)
def drag_clear_record_data(
    arm: ArmState, now: float, request: m.DragClearRecordData
) -> m.DragClearRecordDataReply:
    """Forget the recording; reply with the number of points left."""
    arm.recorded.clear()
    arm.played = 0
    return m.DragClearRecordDataReply(points=0)


@behaviour(m.DragGetRecordData)
def drag_get_record_data(
    arm: ArmState, now: float, request: m.DragGetRecordData
) -> m.DragGetRecordDataReply | None:
    """Reply with the next point: each joint's encoder and speed in turn; zeros after the last."""
    if arm.played >= len(arm.recorded):
        arm.played = 0
        return None
    encoders, speeds = arm.recorded[arm.played]
    arm.played += 1
    return m.DragGetRecordDataReply(
        point=row(part for pair in zip(encoders, speeds) for part in pair)
    )
