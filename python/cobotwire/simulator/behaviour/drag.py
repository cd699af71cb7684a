"""Recording a motion that is done by hand."""

from __future__ import annotations

from cobotwire.editions.mycobot280.messages import (
    DragClearRecordData,
    DragClearRecordDataReply,
    DragEndRecord,
    DragEndRecordReply,
    DragGetRecordData,
    DragGetRecordDataReply,
    DragGetRecordLen,
    DragGetRecordLenReply,
    DragStartRecord,
    DragStartRecordReply,
)
from cobotwire.simulator.behaviour.registry import behaviour, row
from cobotwire.simulator.state import ArmState


@behaviour(DragStartRecord)
def drag_start_record(arm: ArmState, now: float, request: DragStartRecord) -> DragStartRecordReply:
    """Begin to record; reply with the number of points."""
    arm.settings.recording = True
    _record(arm, now)
    return DragStartRecordReply(points=len(arm.settings.recorded))


@behaviour(DragEndRecord)
def drag_end_record(arm: ArmState, now: float, request: DragEndRecord) -> DragEndRecordReply:
    """End the recording; reply with the number of points."""
    if arm.settings.recording:
        _record(arm, now)
    arm.settings.recording = False
    return DragEndRecordReply(points=len(arm.settings.recorded))


@behaviour(DragGetRecordLen)
def drag_get_record_len(
    arm: ArmState, now: float, request: DragGetRecordLen
) -> DragGetRecordLenReply:
    """Reply with the number of recorded points."""
    return DragGetRecordLenReply(points=len(arm.settings.recorded))


@behaviour(DragClearRecordData)
def drag_clear_record_data(
    arm: ArmState, now: float, request: DragClearRecordData
) -> DragClearRecordDataReply:
    """Forget the recording; reply with the number of points left."""
    arm.settings.recorded.clear()
    arm.settings.played = 0
    return DragClearRecordDataReply(points=0)


@behaviour(DragGetRecordData)
def drag_get_record_data(
    arm: ArmState, now: float, request: DragGetRecordData
) -> DragGetRecordDataReply | None:
    """Reply with the next point: each joint's encoder and speed in turn; zeros after the last."""
    settings = arm.settings
    if settings.played >= len(settings.recorded):
        settings.played = 0
        return None
    encoders, speeds = settings.recorded[settings.played]
    settings.played += 1
    return DragGetRecordDataReply(
        point=row(part for pair in zip(encoders, speeds) for part in pair)
    )


def _record(arm: ArmState, now: float) -> None:
    encoders = tuple(arm.encoder(joint, now) for joint in range(arm.joints))
    arm.settings.recorded.append((encoders, (0,) * arm.joints))
