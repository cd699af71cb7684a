"""The devices of a simulated robot: the arm itself, or each limb that has an address."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.kinematics import Geometry
from cobotwire.protocol.addresses import find_address, lacks_joints
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.table import Address, Command, Table
from cobotwire.simulator.effects import begin
from cobotwire.simulator.start import coordinates, steps
from cobotwire.simulator.state import ArmState


def new_state(
    table: Table, geometry: Geometry | None, address: int | None, lag: float = 0.0
) -> ArmState:
    """Return the state after the start of a device with an address, or of the arm."""
    device = _device(table, address)
    joints = (device.joints if device else 0) or table.joints
    own_geometry = geometry if joints == table.joints else None
    state = ArmState(joints, own_geometry, table.robot, coordinates(table), steps(table), lag)
    for joint, (lowest, highest) in enumerate(joint_limits(table)[:joints]):
        state.minimum[joint], state.maximum[joint] = lowest, highest
    begin(table, state)
    return state


def missing_joints(
    table: Table, command: Command, given: Mapping[str, Any], address: int | None
) -> str:
    """Return why a device lacks the joints that a request is about; empty if it has them."""
    device = _device(table, address)
    if device is None or not device.joints:
        return ""
    if given.get("joint", 0) > device.joints:
        return f"{device.name} has no joint {given['joint']}"
    why = lacks_joints(table, device, command)
    return f"{command.name} {why}" if why else ""


def replies_to(table: Table, address: int | None, replies: list[bytes]) -> list[bytes]:
    """Select, from the replies of all devices, those that answer a request to an address."""
    receiver = _device(table, address)
    if receiver is None or receiver.replies in ("own", "any"):
        return replies
    sent = [reply for reply in replies if reply]
    return sent[:1] if receiver.replies == "one" else []


def _device(table: Table, address: int | None) -> Address | None:
    return None if address is None else find_address(table, address)
