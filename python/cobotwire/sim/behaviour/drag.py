"""Recording a motion that is done by hand."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState


@does("drag_start_record")
def drag_start_record(arm: ArmState, now: float) -> dict[str, Any]:
    """Begin to record; gives the points so far."""
    arm.settings.recording = True
    _record(arm, now)
    return {"points": len(arm.settings.recorded)}


@does("drag_end_record")
def drag_end_record(arm: ArmState, now: float) -> dict[str, Any]:
    """End the recording; gives its points."""
    if arm.settings.recording:
        _record(arm, now)
    arm.settings.recording = False
    return {"points": len(arm.settings.recorded)}


@does("drag_get_record_len")
def drag_get_record_len(arm: ArmState, now: float) -> dict[str, Any]:
    """How many points are recorded."""
    return {"points": len(arm.settings.recorded)}


@does("drag_clear_record_data")
def drag_clear_record_data(arm: ArmState, now: float) -> dict[str, Any]:
    """Forget the recording; gives the points left."""
    arm.settings.recorded.clear()
    arm.settings.played = 0
    return {"points": 0}


@does("drag_get_record_data")
def drag_get_record_data(arm: ArmState, now: float) -> dict[str, Any]:
    """The next point: each joint's encoder and speed in turn; zeros behind the last."""
    settings = arm.settings
    if settings.played >= len(settings.recorded):
        settings.played = 0
        return {}
    encoders, speeds = settings.recorded[settings.played]
    settings.played += 1
    return {"point": tuple(part for pair in zip(encoders, speeds) for part in pair)}


def _record(arm: ArmState, now: float) -> None:
    encoders = tuple(arm.encoder(joint, now) for joint in range(arm.joints))
    arm.settings.recorded.append((encoders, (0,) * arm.joints))
