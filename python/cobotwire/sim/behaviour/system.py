"""Versions, errors and modes of newer firmware."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState

# What a 280 of today says of itself; the kinematics notes speak of firmware 6.5.
SYSTEM_VERSION = 6.5
BASIC_VERSION = 2.0
REVISION = 1


@does("get_modify_version")
def get_modify_version(arm: ArmState, now: float) -> dict[str, Any]:
    """The firmware's revision."""
    return {"revision": REVISION}


@does("get_system_version")
def get_system_version(arm: ArmState, now: float) -> dict[str, Any]:
    """The firmware's version."""
    return {"version": SYSTEM_VERSION}


@does("get_basic_version")
def get_basic_version(arm: ArmState, now: float) -> dict[str, Any]:
    """The base's version."""
    return {"version": BASIC_VERSION}


@does("check_async_or_sync")
def check_async_or_sync(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether a motion is acknowledged at its end; here it is as soon as it is heard."""
    return {"synchronous": False}


@does("get_reboot_count")
def get_reboot_count(arm: ArmState, now: float) -> dict[str, Any]:
    """How often the controller has started: once when it was made, and after each panic."""
    return {"reboots": arm.starts}


@does("get_error_information")
def get_error_information(arm: ArmState, now: float) -> dict[str, Any]:
    """The last error; 0 is none."""
    return {"error": arm.settings.error}


@does("clear_error_information")
def clear_error_information(arm: ArmState, now: float) -> None:
    """Forget the last error."""
    arm.settings.error = 0


@does("get_fresh_mode")
def get_fresh_mode(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether targets queue up."""
    return {"mode": arm.fresh_mode}


@does("set_movement_type")
def set_movement_type(arm: ArmState, now: float, mode: int) -> None:
    """Choose the path to a coordinate target."""
    arm.settings.movement_type = mode


@does("get_movement_type")
def get_movement_type(arm: ArmState, now: float) -> dict[str, Any]:
    """The path to a coordinate target."""
    return {"mode": arm.settings.movement_type}


@does("set_vision_mode")
def set_vision_mode(arm: ArmState, now: float, vision: int) -> None:
    """Keep the end from turning over, or not."""
    arm.settings.vision = bool(vision)


@does("set_transponder_mode")
def set_transponder_mode(arm: ArmState, now: float, transparent: int) -> dict[str, Any]:
    """Pass frames on, or not."""
    arm.settings.transparent = bool(transparent)
    return {"succeeded": True}


@does("get_transponder_mode")
def get_transponder_mode(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether frames are passed on."""
    return {"transparent": arm.settings.transparent}
