"""Calibrations, which assign a fixed number to a position and cannot be restored."""

from __future__ import annotations

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE_OR_REPLY, request_change
from cobotwire.conformance.device.groups.settings import NEIGHBOURS
from cobotwire.conformance.device.groups.switching import EFFECT
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import has_fixed_effect, settings_of
from cobotwire.conformance.device.samples import Values, arguments, harmless
from cobotwire.conformance.suite import Group
from cobotwire.protocol.table import Command, Table


def _is_calibration(table: Table, command: Command) -> bool:
    """Return whether a command permanently sets what a query reports to a fixed value."""
    return has_fixed_effect(command) and command.safety == "persistent write"


def _calibrate(probe: Probe) -> None:
    """Calibrate each part in turn, at a pose that is not zero; the other parts stay."""
    command, device = probe.command, probe.device
    assert command.read_by is not None
    query = device.table.command(command.read_by.query)
    [(name, wanted)] = command.read_by.fields
    if not command.request[-1].fields:
        probe.drop(NEIGHBOURS)
    if device.permissions.workspace:
        mover = Mover(probe)
        mover.go(mover.pose(0))
        _set_off(probe, mover, query)
    for part in harmless(command):
        before = _reported(probe, query, name)
        request_change(probe, command, part)
        for other, value in _reported(probe, query, name).items():
            mine = other == part
            right = int(wanted) if mine else before[other]
            expected = f"after {command.name}{part}: expected {query.name}{other} to report {right}"
            case = EFFECT if mine else NEIGHBOURS
            probe.expect(case, value == right, f"{expected}; came {value}")


def _reported(probe: Probe, query: Command, name: str) -> dict[Values, object]:
    """Return what the query reports of each part."""
    found: dict[Values, object] = {}
    for part in arguments(query.request[-1]):
        fields = probe.device.read(query, part)
        if fields is None:
            raise NotSupported(f"{query.name} reports nothing")
        found[part] = fields[name]
    return found


def _set_off(probe: Probe, mover: Mover, query: Command) -> None:
    """Move what is calibrated, such as a gripper, away from its zero, if a motion sets it."""
    device = probe.device
    for command in device.table.commands:
        if command.safety != "motion" or command.role or command.request[0].fields[1:] == ():
            continue
        for motion in settings_of(device.table, command):
            if motion.query is query and not motion.keys[0]:
                fields = device.read(query)
                if fields is None:
                    raise NotSupported(f"{query.name} reports nothing")
                old = motion.reported(fields)
                values = motion.request(motion.rest(mover.speed), motion.samples({}, old)[0])[0]
                device.request(command, values)
                mover.settle(lambda: device.read(query))
                return


CALIBRATION = Group(
    "calibrations",
    (EFFECT, NEIGHBOURS, *AFTER_CHANGE_OR_REPLY),
    _calibrate,
    _is_calibration,
    frozenset({"irreversible"}),
)
