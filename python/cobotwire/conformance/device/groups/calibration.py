"""Calibrations, which assign a fixed number to a position and cannot be restored."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE_OR_REPLY, request_change
from cobotwire.conformance.device.groups.settings import NEIGHBOURS
from cobotwire.conformance.device.groups.switching import EFFECT
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import has_fixed_effect, settings_of
from cobotwire.conformance.device.requests import arguments_of, harmless, requests
from cobotwire.conformance.suite import Group
from cobotwire.protocol.messages import Request
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
        request_change(probe, part)
        for other, value in _reported(probe, query, name).items():
            mine = other.values == part.values
            right = int(wanted) if mine else before[other]
            expected = f"expected {query.name}({arguments_of(other)}) to report {right}"
            expected = f"after {command.name}({arguments_of(part)}): {expected}"
            case = EFFECT if mine else NEIGHBOURS
            probe.expect(case, value == right, f"{expected}; came {value}")


def _reported(probe: Probe, query: Command, name: str) -> dict[Request[Any], object]:
    """Return what the query reports of each part."""
    parts = requests(query, query.request[-1])
    return {part: getattr(probe.device.require(part), name) for part in parts}


def _set_off(probe: Probe, mover: Mover, query: Command) -> None:
    """Move what is calibrated, such as a gripper, away from its zero, if a motion sets it."""
    device, position = probe.device, query.request_type
    for command in device.table.commands:
        if command.safety != "motion" or command.role or command.request[0].fields[1:] == ():
            continue
        for motion in settings_of(device.table, command):
            if motion.query is query and not motion.query_variant.fields:
                old = device.require(position())
                device.request(motion.samples(position(), old, mover.speed)[0])
                mover.settle(lambda: device.read(position()))
                return


CALIBRATION = Group(
    "calibrations",
    (EFFECT, NEIGHBOURS, *AFTER_CHANGE_OR_REPLY),
    _calibrate,
    _is_calibration,
    frozenset({"irreversible"}),
    sends="The calibration for each part, at a pose that is not zero.",
    subject="each permanent command that gives a position a fixed number",
)
