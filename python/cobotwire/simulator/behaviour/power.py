"""Power, free mode and the servos' hold."""

from __future__ import annotations

from cobotwire.editions.mycobot280.messages import (
    IsControllerConnected,
    IsControllerConnectedReply,
    IsFreeMode,
    IsFreeModeReply,
    IsPowerOn,
    IsPowerOnReply,
    PowerOff,
    PowerOn,
    ReleaseAllServos,
    SetFreeMode,
)
from cobotwire.simulator.behaviour.registry import behaviour
from cobotwire.simulator.state import ArmState


@behaviour(PowerOn)
def power_on(arm: ArmState, now: float, request: PowerOn) -> None:
    """Power and hold every joint where it is; connect the Atom. A stop stays in force."""
    arm.connected = True
    arm.powered, arm.free = True, False
    arm.enabled = [True] * arm.joints


@behaviour(PowerOff)
def power_off(arm: ArmState, now: float, request: PowerOff) -> None:
    """End every motion, release the joints, and disconnect the Atom."""
    arm.halt(now)
    arm.gripper.halt(now)
    arm.powered, arm.connected = False, False
    arm.enabled = [False] * arm.joints


@behaviour(IsPowerOn)
def is_power_on(arm: ArmState, now: float, request: IsPowerOn) -> IsPowerOnReply:
    """Reply whether the arm is powered."""
    return IsPowerOnReply(powered=arm.powered)


@behaviour(ReleaseAllServos)
def release_all_servos(arm: ArmState, now: float, request: ReleaseAllServos) -> None:
    """Release every joint."""
    arm.halt(now)
    arm.enabled = [False] * arm.joints


@behaviour(IsControllerConnected)
def is_controller_connected(
    arm: ArmState, now: float, request: IsControllerConnected
) -> IsControllerConnectedReply:
    """Reply whether the Atom is connected: not between power_off and power_on."""
    return IsControllerConnectedReply(connected=arm.connected)


@behaviour(SetFreeMode)
def set_free_mode(arm: ArmState, now: float, request: SetFreeMode) -> None:
    """Switch the torque off or on."""
    arm.free = bool(request.free)
    if arm.free:
        arm.halt(now)


@behaviour(IsFreeMode)
def is_free_mode(arm: ArmState, now: float, request: IsFreeMode) -> IsFreeModeReply:
    """Reply whether the torque is off."""
    return IsFreeModeReply(free=arm.free)
