"""A motion that is sent to one device of a robot moves that device and no other one."""

from __future__ import annotations

from collections.abc import Iterable

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.groups.motion import ARRIVES
from cobotwire.conformance.device.mover import POSES, Mover, Pose, off_by
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.addresses import devices_of
from cobotwire.protocol.table import Address, Command, Table

OTHERS = TestCase("others-rest", "A motion that is sent to one device moves no other one.")


def _is_sent_to_several(table: Table, command: Command) -> bool:
    """Return whether a command moves all joints, and several devices have all of them."""
    return command is table.find_role("joint targets") and len(_arms(table)) > 1


def _arms(table: Table) -> list[Address]:
    """Return the devices that have all joints of the edition."""
    return [device for device in devices_of(table) if device.joints in (0, table.joints)]


def _one_moves(probe: Probe) -> None:
    """Move one permitted device after another; read the joints of all devices after each."""
    device, mover, arms = probe.device, Mover(probe.device), _arms(probe.device.edition)
    driven = [arm for arm in arms if arm == device.address] or arms
    before = {arm.name: _pose(device, arm) for arm in arms}
    for arm in driven:
        with device.requester.addressed(arm):
            target = _far_from(mover, before.values())
            mover.go(target)
            wrong = mover.differences(target)
        probe.expect(ARRIVES, not wrong, f"{probe.command.name} to {arm.name}: {'; '.join(wrong)}")
        for other in arms:
            was, before[other.name] = before[other.name], _pose(device, other)
            if other != arm:
                moved = off_by(before[other.name], was, mover.tolerance, "was at")
                reason = f"{probe.command.name} to {arm.name} must not move {other.name}"
                probe.expect(OTHERS, not moved, f"{reason}: {'; '.join(moved)}")


def _far_from(mover: Mover, places: Iterable[Pose]) -> Pose:
    """Return the pose in which the first joint is farthest from all poses in ``places``."""
    poses, taken = map(mover.pose, range(len(POSES))), [place[0] for place in places]
    return max(poses, key=lambda pose: min(abs(pose[0] - angle) for angle in taken))


def _pose(device: Device, arm: Address) -> Pose:
    """Return the angles of a device.

    Raises:
        NotSupported: it does not report them.
    """
    query = device.command("joints")
    if query is None:
        raise NotSupported("no query reports the joints")
    with device.requester.addressed(arm):
        return tuple(device.require(query.request_type()).result)


ADDRESSES = Group(
    "one device of several",
    (ARRIVES, OTHERS),
    _one_moves,
    _is_sent_to_several,
    sends=(
        "A pose to each device in turn, or only to the device of the run's address; after each, "
        "the joints of all devices are read."
    ),
    subject="the command that moves all joints, if several devices with addresses have them",
)
