"""A value that is set is read back, and nothing else changes.

A value that is not allowed changes nothing.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import (
    AFTER_CHANGE,
    AFTER_CHANGE_OR_REPLY,
    REPLIED,
    request_change,
)
from cobotwire.conformance.device.groups.malformed import (
    MALFORMED,
    OUT_OF_RANGE,
    forbidden,
    wrong_values,
)
from cobotwire.conformance.device.malformed_sender import KEPT
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.read_back import (
    SavedValue,
    restorable_value,
    saved_value,
    settings_of,
)
from cobotwire.conformance.device.requests import arguments_of, values_text
from cobotwire.conformance.device.selection import reported, reporters
from cobotwire.conformance.hex_text import shown
from cobotwire.conformance.located import located_numbers
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.effects import Stores, effect_of
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table

READ_BACK = TestCase("read-back", "What was set is what is read.")
NEIGHBOURS = TestCase(
    "neighbours-stay", "Setting one joint, pin or register does not change the others."
)
RESTORED = TestCase("restored", "The value before a test can be set again, and is read back.")
OTHERS = TestCase("others-stay", "A setting changes nothing but what it sets.")
AMONG = TestCase("set-is-reported", "One of the numbers that the query reports is what was set.")

# The values to set if the query reports several numbers, as shares of the setting's range.
SHARES = (0.3, 0.7)


def _is_setting(table: Table, command: Command) -> bool:
    """Return whether a query reads a setting back, so that the setting can be restored."""
    return command.safety not in ("query", "motion") and bool(settings_of(table, command))


def _set_and_read(probe: Probe) -> None:
    """Back up, set several values for each joint, pin or register, read all, restore."""
    device, may_lose = probe.device, "irreversible" in probe.device.permissions.classes
    settings = settings_of(device.table, probe.command)
    # Settings of the numbers that one query reports are tested together, as neighbours. Variants
    # set the same value, so each is tested by itself.
    sets = [settings] if settings[0].part else [[setting] for setting in settings]
    for together in sets:
        all_saved = [
            restorable_value(device, setting, query, or_lost=may_lose)
            for setting in together
            for query in setting.queries
        ]
        if len(all_saved) == 1:
            probe.drop(NEIGHBOURS)
        restore = device.restore_after_body
        for saved in all_saved:
            if not saved.obstacle:
                restore[str(saved)] = partial(_set, probe, saved.old)
        for saved in all_saved:
            _try(probe, saved, all_saved)
            restore.pop(str(saved), None)


def _set(probe: Probe, wanted: Request[Any]) -> bool:
    """Set a value; return whether its reply reports a failure."""
    valid = request_change(probe, wanted).valid
    if valid is None or valid.decoded is None:
        return False
    flags = [f.name for f in valid.decoded.variant.fields if f.kind == "flag" and not f.echo]
    return any(not getattr(valid.message, name) for name in flags)


def _try(probe: Probe, saved: SavedValue, all_saved: list[SavedValue]) -> None:
    for index, wanted in enumerate(saved.samples):
        failed = _set(probe, wanted)
        _expect(probe, READ_BACK, saved, wanted)
        reason = f"{saved} reports failure, but {wanted} is read back"
        probe.expect(REPLIED, not failed, reason)
        for other in all_saved if index == 0 else ():
            # A setting that could not be restored no longer has its old value.
            if other.index != saved.index and not other.obstacle:
                _expect(probe, NEIGHBOURS, other, other.old, f"after {saved}: ")
    if not saved.obstacle:
        _set(probe, saved.old)
        _expect(probe, RESTORED, saved, saved.old)


def _expect(
    probe: Probe, case: TestCase, saved: SavedValue, wanted: Request[Any], when: str = ""
) -> None:
    wrong = saved.setting.differences(wanted, probe.device.read(saved.query))
    probe.expect(case, not wrong, f"{when}{saved}, {'; '.join(wrong)}")


def _takes_forbidden_values(table: Table, command: Command) -> bool:
    """Return whether a setting that a query reads back can be sent a value that is not allowed."""
    return command.safety == "setting" and any(
        any(map(forbidden, located_numbers(setting.variant)))
        for setting in settings_of(table, command)
    )


def _forbidden(probe: Probe) -> None:
    """Set two values in turn; after each, send wrong values, and read that nothing changes.

    With two values, the result of a wrong value differs from at least one of them.
    """
    device = probe.device
    for setting in settings_of(device.table, probe.command):
        if setting.place:
            # The first number represents the others.
            continue
        saved = restorable_value(device, setting, setting.queries[0])
        device.restore_after_body[probe.command.name] = partial(device.request, saved.old)
        for present in saved.samples[:2]:
            _send_wrong_values(probe, saved, present)
        device.request(saved.old)


def _send_wrong_values(probe: Probe, saved: SavedValue, present: Request[Any]) -> None:
    device = probe.device
    device.request(present)
    encoded = device.requester.prepare(present)
    for what, listed, data in wrong_values(device.table, saved.setting.variant, encoded.frame):
        # With another constant the frame may be a legal request of another command.
        if device.requester.is_legal(data):
            continue
        response = device.requester.send_bytes(encoded, data, what, device.timing.silence)
        after = device.request(saved.query)
        # A late reply comes after the query.
        silent = not (response.replies or response.unexpected or after.others)
        received = response.summary if response.replies or response.unexpected else after.summary
        probe.expect(OUT_OF_RANGE, silent, f"{what}: expected no reply; received {received}")
        reply = after.valid and after.valid.message
        wrong = saved.setting.differences(present, reply)
        reason = f"{probe.command.name} with {what} ({shown(data)}) must change nothing"
        # For a number beyond its range, the device may set the nearest legal one.
        limited = reply is not None and not listed
        probe.expect(KEPT, limited or not wrong, f"{reason}; {'; '.join(wrong)}")
        if wrong:
            device.request(present)


def _others_stay(probe: Probe) -> None:
    """Give each setting a value that is not its default; change one after the other."""
    device = probe.device
    all_saved: dict[str, SavedValue] = {}
    for command in device.table.commands:
        # One of two settings that the same query reads is enough.
        settings = settings_of(device.table, command) if command.safety == "setting" else []
        for setting in settings[:1]:
            saved = saved_value(device, setting, setting.queries[0])
            if saved is not None and not saved.obstacle and saved.others:
                all_saved.setdefault(saved.query.command, saved)
    if len(all_saved) < 2:
        raise NotSupported("fewer than two settings can be read back")
    for name, saved in all_saved.items():
        device.restore_after_body[name] = partial(device.request, saved.old)
        device.request(saved.others[0])
    before = {name: device.read(saved.query) for name, saved in all_saved.items()}
    for name, saved in all_saved.items():
        second = [*saved.others, saved.old][1]
        device.request(second)
        changed = [
            f"{other.query.command}({arguments_of(other.query)}) from "
            f"{values_text(before[each])} to {values_text(now)}"
            for each, other in all_saved.items()
            if each != name and before[each] is not None
            if (now := device.read(other.query)) != before[each]
        ]
        call = f"{second.command}({arguments_of(second)})"
        probe.expect(OTHERS, not changed, f"{call} also changes {'; '.join(changed)}")
        # Set again everything that has changed.
        for each in all_saved.values() if changed else (saved,):
            device.request(each.others[0])


def is_shown(table: Table, command: Command) -> Command | None:
    """Return the query that reports what a setting stores among other numbers of its unit.

    No source says which of them it is.
    """
    effect = effect_of(command) if command.safety == "setting" else None
    states = set(effect.values.values()) if isinstance(effect, Stores) and effect.assumed else ()
    found = (each.query for state in states for each in reporters(table, state))
    return next((query for query in found if len(reported(query)) > 1), None)


def _set_among(probe: Probe, query: Command) -> None:
    """Set two values, and read after each; then restore what was read before."""
    device, command = probe.device, probe.command
    before = set(device.require(query.request_type()).fields.values())
    if len(before) != 1:
        raise NotSupported(f"{query.name} reports several numbers; which one is set is unknown")
    device.restore_after_body[command.name] = partial(device.request, _to(command, *before))
    number = command.request[0].fields[0].cases[0].numbers[0]
    for share in SHARES:
        raw = number.minimum + round(share * (number.maximum - number.minimum))
        value = number.physical(raw)
        request_change(probe, _to(command, value))
        shown = device.require(query.request_type()).fields
        reason = f"{command.name}({value:g}): expected {query.name} to report it; received {shown}"
        probe.expect(AMONG, value in shown.values(), reason)


def _to(command: Command, value: Any) -> Any:
    return command.request_type.from_fields({command.request[0].fields[0].name: value})


SETTINGS = Group(
    "settings",
    (READ_BACK, NEIGHBOURS, RESTORED, *AFTER_CHANGE_OR_REPLY),
    _set_and_read,
    _is_setting,
    sends=(
        "For each joint, pin or register: both ends, both signs, and a set of numbers that all "
        "differ; then the value before."
    ),
    subject="each setting that a query reads back",
)
FORBIDDEN_SETTINGS = Group(
    "forbidden values of settings",
    (OUT_OF_RANGE, KEPT),
    _forbidden,
    _takes_forbidden_values,
    MALFORMED,
    sends=(
        "The setting with values next to the allowed ones, and the largest that the bytes can "
        "hold; after each, the query that reads it."
    ),
    subject="each setting that a query reads back and that can be out of range",
)
SHOWN_AMONG = Group(
    "set among others",
    (AMONG, *AFTER_CHANGE),
    *for_found(is_shown, _set_among),
    sends="Two values, and the query after each.",
    subject="each setting, if its query reports several numbers, and it is unknown which is set",
)
COUPLING = Group(
    "settings among each other",
    (OTHERS,),
    _others_stay,
    permission=frozenset({"setting"}),
    sends="Two values for each setting, one after the other; all other settings are read.",
    subject="the transport as a whole",
)
