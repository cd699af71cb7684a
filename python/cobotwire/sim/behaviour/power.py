"""Power, free mode and the servos' hold."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState


@does("power_on")
def power_on(arm: ArmState, now: float) -> None:
    """Power and hold every joint where it stands; connect the Atom. A stop outlives it."""
    arm.connected = True
    arm.powered, arm.free = True, False
    arm.enabled = [True] * arm.joints


@does("power_off")
def power_off(arm: ArmState, now: float) -> None:
    """End every motion, let go, and break the connection to the Atom."""
    arm.halt(now)
    arm.gripper.halt(now)
    arm.powered, arm.connected = False, False
    arm.enabled = [False] * arm.joints


@does("is_power_on")
def is_power_on(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the arm is powered."""
    return {"powered": arm.powered}


@does("release_all_servos")
def release_all_servos(arm: ArmState, now: float, undamped: int = 0) -> None:
    """Let go of every joint."""
    arm.halt(now)
    arm.enabled = [False] * arm.joints


@does("is_controller_connected")
def is_controller_connected(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the Atom is there: until power_off, and again from power_on."""
    return {"connected": arm.connected}


@does("set_free_mode")
def set_free_mode(arm: ArmState, now: float, free: int) -> None:
    """Switch the torque off or on."""
    arm.free = bool(free)
    if arm.free:
        arm.halt(now)


@does("is_free_mode")
def is_free_mode(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the torque is off."""
    return {"free": arm.free}
