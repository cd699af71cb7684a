"""Settings that are stored and read back; versions and errors of newer firmware."""

from __future__ import annotations

from cobotwire.editions.mycobot.messages import GetSpeed, SetSpeed
from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.registry import behaviour, query, reported, stored
from cobotwire.simulator.state import ArmState

# The tool and world references; the frame (base or world) and the end (flange or tool) in use.
stored("tool", m.SetToolReference, m.GetToolReference)
stored("world", m.SetWorldReference, m.GetWorldReference)
stored("reference_frame", m.SetReferenceFrame, m.GetReferenceFrame)
stored("end_type", m.SetEndType, m.GetEndType)
# Whether targets are queued, and how the end moves to coordinates.
stored("fresh_mode", m.SetFreshMode, m.GetFreshMode)
stored("movement_type", m.SetMovementType, m.GetMovementType)
# The speed of commands that have no speed of their own.
stored("speed", SetSpeed, GetSpeed)
# The current at which the gripper protects itself.
stored("gripper_current", m.SetGripperProtectCurrent, m.GetGripperProtectCurrent)
# A motion is acknowledged when it is received, not when it ends.
query(m.CheckAsyncOrSync, lambda arm, now, request: False)
# The controller starts when it is switched on, and again after each panic.
query(m.GetRebootCount, lambda arm, now, request: arm.starts)


@behaviour(m.ClearErrorInformation)
def clear_error_information(arm: ArmState, now: float, request: m.ClearErrorInformation) -> None:
    """Clear the last error."""
    arm.error = 0


@behaviour(m.SetVisionMode)
def set_vision_mode(arm: ArmState, now: float, request: m.SetVisionMode) -> None:
    """Set whether the end is kept from turning over."""
    arm.vision = bool(request.vision)


@behaviour(m.SetTransponderMode)
def set_transponder_mode(
    arm: ArmState, now: float, request: m.SetTransponderMode
) -> m.SetTransponderModeReply:
    """Set whether frames are passed on."""
    arm.transparent = bool(request.transparent)
    return m.SetTransponderModeReply(succeeded=True)


query(m.GetTransponderMode, lambda arm, now, request: arm.transparent)


reported(m.GetSsidPwd, ssid="ssid", password="password")  # noqa: S106  (an attribute's name)


@behaviour(m.GetSsidPwd)
def get_ssid_pwd(arm: ArmState, now: float, request: m.GetSsidPwd) -> m.GetSsidPwdReply:
    """Reply with the Wi-Fi account."""
    return m.GetSsidPwdReply(ssid=arm.ssid, password=arm.password)


@behaviour(m.SetSsidPwd)
def set_ssid_pwd(arm: ArmState, now: float, request: m.SetSsidPwd) -> None:
    """Set the Wi-Fi account, which follows the frame as text."""
    arm.ssid, arm.password = request.account, request.password


@behaviour(m.SetServerPort)
def set_server_port(arm: ArmState, now: float, request: m.SetServerPort) -> None:
    """Set the TCP port."""
    arm.port = request.port
