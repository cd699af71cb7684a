"""The checks of a Mercury or a Pro arm that can be turned on and off."""

from __future__ import annotations

from cobotwire.editions.mercury_a1 import messages as m
from cobotwire.editions.mercury_a1.enums import LimitCheck
from cobotwire.simulator.behaviour.mercury import MERCURY
from cobotwire.simulator.state import ArmState


@MERCURY.behaviour(m.SetLimitSwitch)
def set_limit_switch(arm: ArmState, now: float, request: m.SetLimitSwitch) -> None:
    """Turn the check of positions, or the report of the end of motions, on or off."""
    if request.check == LimitCheck.MOTION_END:
        arm.reports_ends = bool(request.on)
    else:
        arm.checks_position = bool(request.on)


@MERCURY.behaviour(m.GetLimitSwitch)
def get_limit_switch(arm: ArmState, now: float, request: m.GetLimitSwitch) -> m.GetLimitSwitchReply:
    """Reply with both; a power cycle turns both on."""
    return m.GetLimitSwitchReply(arm.checks_position, arm.reports_ends)
