"""Tool and world reference, reference frame and end type: what coordinates refer to."""

from __future__ import annotations

from cobotwire.editions.mycobot280.enums import EndType, ReferenceFrame
from cobotwire.editions.mycobot280.messages import (
    GetEndType,
    GetEndTypeReply,
    GetReferenceFrame,
    GetReferenceFrameReply,
    GetToolReference,
    GetToolReferenceReply,
    GetWorldReference,
    GetWorldReferenceReply,
    SetEndType,
    SetReferenceFrame,
    SetToolReference,
    SetWorldReference,
)
from cobotwire.simulator.behaviour.registry import behaviour, row
from cobotwire.simulator.state import ArmState


@behaviour(SetToolReference)
def set_tool_reference(arm: ArmState, now: float, request: SetToolReference) -> None:
    """Set the tool's point."""
    arm.tool = tuple(request.coords)


@behaviour(GetToolReference)
def get_tool_reference(
    arm: ArmState, now: float, request: GetToolReference
) -> GetToolReferenceReply:
    """Reply with the tool's point."""
    return GetToolReferenceReply(coords=row(arm.tool))


@behaviour(SetWorldReference)
def set_world_reference(arm: ArmState, now: float, request: SetWorldReference) -> None:
    """Set the world's origin."""
    arm.world = tuple(request.coords)


@behaviour(GetWorldReference)
def get_world_reference(
    arm: ArmState, now: float, request: GetWorldReference
) -> GetWorldReferenceReply:
    """Reply with the world's origin."""
    return GetWorldReferenceReply(coords=row(arm.world))


@behaviour(SetReferenceFrame)
def set_reference_frame(arm: ArmState, now: float, request: SetReferenceFrame) -> None:
    """Choose base or world."""
    arm.reference_frame = request.frame


@behaviour(GetReferenceFrame)
def get_reference_frame(
    arm: ArmState, now: float, request: GetReferenceFrame
) -> GetReferenceFrameReply:
    """Reply with base or world."""
    return GetReferenceFrameReply(frame=ReferenceFrame(arm.reference_frame))


@behaviour(SetEndType)
def set_end_type(arm: ArmState, now: float, request: SetEndType) -> None:
    """Choose flange or tool."""
    arm.end_type = request.end


@behaviour(GetEndType)
def get_end_type(arm: ArmState, now: float, request: GetEndType) -> GetEndTypeReply:
    """Reply with flange or tool."""
    return GetEndTypeReply(end=EndType(arm.end_type))
