"""Tool and world reference, reference frame and end type: what coordinates are given in."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState


@does("set_tool_reference")
def set_tool_reference(arm: ArmState, now: float, coords: tuple[float, ...]) -> None:
    """Set the tool's point."""
    arm.tool = coords


@does("get_tool_reference")
def get_tool_reference(arm: ArmState, now: float) -> dict[str, Any]:
    """The tool's point."""
    return {"coords": arm.tool}


@does("set_world_reference")
def set_world_reference(arm: ArmState, now: float, coords: tuple[float, ...]) -> None:
    """Set the world's origin."""
    arm.world = coords


@does("get_world_reference")
def get_world_reference(arm: ArmState, now: float) -> dict[str, Any]:
    """The world's origin."""
    return {"coords": arm.world}


@does("set_reference_frame")
def set_reference_frame(arm: ArmState, now: float, frame: int) -> None:
    """Choose base or world."""
    arm.reference_frame = frame


@does("get_reference_frame")
def get_reference_frame(arm: ArmState, now: float) -> dict[str, Any]:
    """Base or world."""
    return {"frame": arm.reference_frame}


@does("set_end_type")
def set_end_type(arm: ArmState, now: float, end: int) -> None:
    """Choose flange or tool."""
    arm.end_type = end


@does("get_end_type")
def get_end_type(arm: ArmState, now: float) -> dict[str, Any]:
    """Flange or tool."""
    return {"end": arm.end_type}
