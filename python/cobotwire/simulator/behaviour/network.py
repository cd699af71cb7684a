"""Wi-Fi account and port."""

from __future__ import annotations

from cobotwire.editions.mycobot280.messages import (
    GetSsidPwd,
    GetSsidPwdReply,
    SetServerPort,
    SetSsidPwd,
)
from cobotwire.simulator.behaviour.registry import behaviour
from cobotwire.simulator.state import ArmState


@behaviour(GetSsidPwd)
def get_ssid_pwd(arm: ArmState, now: float, request: GetSsidPwd) -> GetSsidPwdReply:
    """Reply with the Wi-Fi account."""
    return GetSsidPwdReply(ssid=arm.ssid, password=arm.password)


@behaviour(SetSsidPwd)
def set_ssid_pwd(arm: ArmState, now: float, request: SetSsidPwd) -> None:
    """Set the Wi-Fi account, which comes as a text after the frame."""
    arm.ssid, arm.password = request.account, request.password


@behaviour(SetServerPort)
def set_server_port(arm: ArmState, now: float, request: SetServerPort) -> None:
    """Set the TCP port."""
    arm.port = request.port
