"""What is set is read back, leaves its neighbours alone, and is restored afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import (
    AFTER_CHANGE_OR_REPLY,
    REPLIED,
    request_change,
)
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, Values, settings_of
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.errors import UsageError
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
    """One joint, pin or register, and its value before the test."""

    setting: Setting
    key: Values
    old: Values
    # Whether the command can set the old value again.
    restorable: bool = True

    def __str__(self) -> str:
        key = ", ".join(f"{name}={value}" for name, value in self.key.items())
        return f"{self.setting.command.name}({key})"


def _set_and_read(probe: Probe) -> None:
    """Back up, set several values for each joint, pin or register, read all, restore."""
    for setting in settings_of(probe.device.table, probe.command):
        spots = [_spot(probe, setting, key) for key in setting.keys]
        if len(spots) == 1:
            probe.drop(NEIGHBOURS)
        restore = probe.device.restore_after_body
        for spot in spots:
            if spot.restorable:
                restore[str(spot)] = partial(_set, probe, spot, spot.old)
        for spot in spots:
            _try(probe, spot, spots)
            restore.pop(str(spot), None)


def _spot(probe: Probe, setting: Setting, key: Values) -> _Spot:
    """Read the value to restore.

    Raises:
        NotSupported: it cannot be read, or cannot be set again.
    """
    old = _read(probe, setting, key)
    if old is None:
        raise NotSupported(f"{setting.query.name} reports nothing, so nothing can be read back")
    values, text = setting.request(key, old)
    try:
        probe.device.requester.prepare(setting.command, values, text)
    except UsageError as error:
        if "irreversible" not in probe.device.permissions.classes:
            raise NotSupported(f"the present value could not be set again: {error}") from None
        return _Spot(setting, key, old, restorable=False)
    return _Spot(setting, key, old)


def _read(probe: Probe, setting: Setting, key: Values) -> Values | None:
    fields = probe.device.read(setting.query, setting.query_arguments(key))
    return None if fields is None else setting.reported(fields)


def _set(probe: Probe, spot: _Spot, wanted: Values) -> bool:
    """Set a value; return whether a reply that is due reports failure."""
    values, text = spot.setting.request(spot.key, wanted)
    valid = request_change(probe, spot.setting.command, values, text).valid
    if valid is None or valid.message is None:
        return False
    flags = [f.name for f in valid.message.variant.fields if f.kind == "flag" and not f.echo]
    return any(not valid.fields[name] for name in flags)


def _try(probe: Probe, spot: _Spot, spots: list[_Spot]) -> None:
    for index, wanted in enumerate(spot.setting.samples(spot.key, spot.old)):
        failed = _set(probe, spot, wanted)
        _expect(probe, READ_BACK, spot, wanted)
        reason = f"{spot} reports failure, but {wanted} is read back"
        probe.expect(REPLIED, not failed, reason)
        for other in spots if index == 0 else ():
            if other is not spot:
                _expect(probe, NEIGHBOURS, other, other.old, f"after {spot}: ")
    if spot.restorable:
        _set(probe, spot, spot.old)
        _expect(probe, RESTORED, spot, spot.old)


def _expect(probe: Probe, case: TestCase, spot: _Spot, wanted: Values, when: str = "") -> None:
    wrong = spot.setting.differences(wanted, _read(probe, spot.setting, spot.key))
    probe.expect(case, not wrong, f"{when}{spot}, {'; '.join(wrong)}")


SETTINGS = Group(
    "settings",
    (READ_BACK, NEIGHBOURS, RESTORED, *AFTER_CHANGE_OR_REPLY),
    _set_and_read,
    _is_setting,
)
