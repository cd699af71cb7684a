"""What is set is read back, leaves its neighbours alone, and is restored afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import (
    AFTER_CHANGE_OR_REPLY,
    REPLIED,
    request_change,
)
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.device.requests import arguments_of
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Command, Table

READ_BACK = TestCase("read-back", "What was set is what is read.")
NEIGHBOURS = TestCase(
    "neighbours-stay", "Setting one joint, pin or register does not change the others."
)
RESTORED = TestCase("restored", "The value before a test can be set again, and is read back.")


def _is_setting(table: Table, command: Command) -> bool:
    """Return whether a query reads a setting back, and its own arguments restore it."""
    return command.safety not in ("query", "motion") and bool(settings_of(table, command))


@dataclass(frozen=True, slots=True)
class _Spot:
    """One joint, pin or register: what reads it, what was read before the test, and what sets it.

    ``restorable`` is whether the command can set the old value again.
    """

    setting: Setting
    query: Request[Any]
    before: Reply[Any]
    old: Request[Any]
    restorable: bool = True

    def __str__(self) -> str:
        return f"{self.old.command}({arguments_of(self.query)})"


def _set_and_read(probe: Probe) -> None:
    """Back up, set several values for each joint, pin or register, read all, restore."""
    for setting in settings_of(probe.device.table, probe.command):
        spots = [_spot(probe, setting, query) for query in setting.queries]
        if len(spots) == 1:
            probe.drop(NEIGHBOURS)
        restore = probe.device.restore_after_body
        for spot in spots:
            if spot.restorable:
                restore[str(spot)] = partial(_set, probe, spot.old)
        for spot in spots:
            _try(probe, spot, spots)
            restore.pop(str(spot), None)


def _spot(probe: Probe, setting: Setting, query: Request[Any]) -> _Spot:
    """Read the value to restore.

    Raises:
        NotSupported: it cannot be read, or cannot be set again.
    """
    before = probe.device.read(query)
    if before is None:
        raise NotSupported(f"{query.command} reports nothing, so nothing can be read back")
    old = setting.again(query, before)
    try:
        probe.device.requester.prepare(old)
    except UsageError as error:
        if "irreversible" not in probe.device.permissions.classes:
            raise NotSupported(f"the present value could not be set again: {error}") from None
        return _Spot(setting, query, before, old, restorable=False)
    return _Spot(setting, query, before, old)


def _set(probe: Probe, wanted: Request[Any]) -> bool:
    """Set a value; return whether a reply that is due reports failure."""
    valid = request_change(probe, wanted).valid
    if valid is None or valid.decoded is None:
        return False
    flags = [f.name for f in valid.decoded.variant.fields if f.kind == "flag" and not f.echo]
    return any(not getattr(valid.message, name) for name in flags)


def _try(probe: Probe, spot: _Spot, spots: list[_Spot]) -> None:
    for index, wanted in enumerate(spot.setting.samples(spot.query, spot.before)):
        failed = _set(probe, wanted)
        _expect(probe, READ_BACK, spot, wanted)
        reason = f"{spot} reports failure, but {wanted} is read back"
        probe.expect(REPLIED, not failed, reason)
        for other in spots if index == 0 else ():
            # What cannot be restored no longer has its old value.
            if other is not spot and other.restorable:
                _expect(probe, NEIGHBOURS, other, other.old, f"after {spot}: ")
    if spot.restorable:
        _set(probe, spot.old)
        _expect(probe, RESTORED, spot, spot.old)


def _expect(
    probe: Probe, case: TestCase, spot: _Spot, wanted: Request[Any], when: str = ""
) -> None:
    wrong = spot.setting.differences(wanted, probe.device.read(spot.query))
    probe.expect(case, not wrong, f"{when}{spot}, {'; '.join(wrong)}")


SETTINGS = Group(
    "settings",
    (READ_BACK, NEIGHBOURS, RESTORED, *AFTER_CHANGE_OR_REPLY),
    _set_and_read,
    _is_setting,
    sends=(
        "For each joint, pin or register: both ends, both signs, a different number for each "
        "part; then the value before."
    ),
    subject="each setting that a query reads back",
)
