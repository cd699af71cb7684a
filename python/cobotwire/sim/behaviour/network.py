"""Wi-Fi account and port."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState


@does("get_ssid_pwd")
def get_ssid_pwd(arm: ArmState, now: float) -> dict[str, Any]:
    """The Wi-Fi account."""
    return {"ssid": arm.ssid, "password": arm.password}


@does("set_ssid_pwd")
def set_ssid_pwd(arm: ArmState, now: float, account: str, password: str) -> None:
    """Set the Wi-Fi account; it came as text behind the frame."""
    arm.ssid, arm.password = account, password


@does("set_server_port")
def set_server_port(arm: ArmState, now: float, port: int) -> None:
    """Set the TCP port."""
    arm.port = port
