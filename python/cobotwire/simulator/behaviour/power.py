"""Power, free mode and the servos' hold."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.registry import behaviour, query
from cobotwire.simulator.state import ArmState


@behaviour(m.PowerOn)
def power_on(arm: ArmState, now: float, request: m.PowerOn) -> None:
    """Power and hold every joint where it is; connect the Atom."""
    led = arm.released
    arm.power_on()
    if led:
        arm.hold(now)


@behaviour(m.PowerOff)
def power_off(arm: ArmState, now: float, request: m.PowerOff) -> None:
    """End every motion, release the joints, and disconnect the Atom."""
    arm.gripper.halt(now)
    arm.powered, arm.connected = False, False
    arm.enabled = [False] * arm.joints
    arm.release(now)


@behaviour(m.ReleaseAllServos)
def release_all_servos(arm: ArmState, now: float, request: m.ReleaseAllServos) -> None:
    """Release every joint."""
    arm.enabled = [False] * arm.joints
    arm.release(now)


# Also in an edition that states no role for it, because the arm may lack it.
query(m.IsPowerOn, lambda arm, now, request: arm.powered)
# The Atom is connected, except between power_off and power_on.
query(m.IsControllerConnected, lambda arm, now, request: arm.connected)


@behaviour(m.SetFreeMode)
def set_free_mode(arm: ArmState, now: float, request: m.SetFreeMode) -> None:
    """Switch the torque off or on."""
    led, arm.free = arm.released, bool(request.free)
    if arm.free:
        arm.release(now)
    elif led:
        arm.hold(now)


query(m.IsFreeMode, lambda arm, now, request: arm.free)
