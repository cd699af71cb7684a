"""Commands with a fixed effect, such as power on: the query reports it, for the right joint."""

from __future__ import annotations

from functools import partial
from typing import Any

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.groups.changes import (
    AFTER_CHANGE,
    AFTER_CHANGE_OR_REPLY,
    request_change,
)
from cobotwire.conformance.device.groups.queries import (
    REPEATS,
    SETTLES,
    is_framed_query,
    request_twice,
)
from cobotwire.conformance.device.groups.settings import NEIGHBOURS
from cobotwire.conformance.device.mover import Mover, give_power
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.read_back import (
    Fixed,
    fixed_effect,
    setter_of,
    settings_of,
)
from cobotwire.conformance.device.requests import (
    arguments_of,
    gentle_values,
    harmless,
    requests,
)
from cobotwire.conformance.device.selection import reporters, stated_effect
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.effects import Cases, Sets
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table


def _reports_done(command: Command) -> bool:
    """Return whether an acknowledgement reports that a command is done, not only accepted."""
    return command.ack and not command.accepted


DONE = TestCase(
    "acknowledged-done",
    "When a command is acknowledged as done, the query reports the new state at once.",
    applies=_reports_done,
)
EFFECT = TestCase("effect", "The query reports the state that the command has set.")

# How long a switch may take to show, and how often it is read, in seconds.
SHOWS = 2.0
POLL = 0.05


def _switch_of(table: Table, command: Command) -> Fixed | None:
    """Return a command's fixed effect that can be reverted; None if it concerns only one joint."""
    fixed, part = fixed_effect(table, command), _part_of(table, command)
    of_one = fixed and part and part.query.name == fixed.query.name
    return None if command.safety == "persistent write" or of_one else fixed


def _switch(probe: Probe, fixed: Fixed) -> None:
    """Set the opposite state, then the command's own, then restore the old one."""
    command, device, (query, _, wanted) = probe.command, probe.device, fixed
    if command.safety == "power":
        give_power(device)
    reading = fixed.for_part(harmless(command)[-1])
    before = fixed.read(device, reading)
    back = setter_of(device.table, query, 1 - wanted) if wanted in (0, 1) else None
    if back is None and before != wanted and "irreversible" not in device.permissions.classes:
        raise NotSupported("no command switches it back: that needs the permission irreversible")
    undo = back if before != wanted else command
    if undo is not None:
        device.restore_after_body[command.name] = partial(_send, probe, undo)
    if back is not None and before == wanted:
        _send(probe, back)
    acknowledged = _send(probe, command)
    value = _read(device, fixed, reading)
    if acknowledged:
        reason = f"{command.name} is acknowledged as done: expected {query.name} to report {wanted}"
        probe.expect(DONE, value == wanted, f"{reason} at once; received {value}")
    else:
        probe.drop(DONE)
    if value != wanted:
        reads = partial(_read, device, fixed, reading)
        value = device.poll(reads, lambda read: read == wanted, SHOWS, POLL)
    reason = f"{command.name}: expected {query.name} to report {wanted}; received {value}"
    probe.expect(EFFECT, value == wanted, reason)
    if command.safety != "power" or wanted:
        probe.drop(REPEATS)
    else:
        _expect_steady_replies(probe)


def _expect(
    probe: Probe, case: TestCase, fixed: Fixed, query: Request[Any], right: int, call: str
) -> None:
    """Expect a query to report a state after a call."""
    value = fixed.read(probe.device, query)
    reason = f"after {call}: expected {query.command}({arguments_of(query)}) to report {right}"
    probe.expect(case, value == right, f"{reason}; received {value}")


def _expect_steady_replies(probe: Probe) -> None:
    """Send each plain query twice: a stale value from before shows in only one of the replies."""
    device = probe.device
    device.rest(SETTLES)
    for query in device.table.commands:
        if is_framed_query(device.table, query) and not query.request[0].fields:
            request_twice(probe, query.request_type())


def _send(probe: Probe, command: Command) -> bool:
    """Send a command for each joint that it accepts; return whether each is acknowledged."""
    acknowledged = [bool(request_change(probe, request).replies) for request in harmless(command)]
    return command.ack and all(acknowledged)


def _read(device: Device, fixed: Fixed, query: Request[Any]) -> int | None:
    reply = device.read(query)
    return None if reply is None else int(getattr(reply, fixed.field))


def _part_of(table: Table, command: Command) -> Fixed | None:
    """Return the query that reports the state that a command sets for one joint, and the value."""
    effect = stated_effect(command)
    if isinstance(effect, Sets) and effect.at and command.safety == "power":
        for state, value in effect.values.items():
            # An assumed query is used too: without it nothing would show which joint a command
            # switches.
            for found in reporters(table, state, assumed=True):
                if found.at == effect.at and len(harmless(command)) > 1:
                    return Fixed(found.query, found.field, int(value))
    return None


def _switch_each(probe: Probe, fixed: Fixed) -> None:
    """Set the opposite state for all joints, then the command's own for each joint in turn."""
    device, parts, wanted = probe.device, harmless(probe.command), fixed.value
    every = fixed_effect(device.table, probe.command)
    give_power(device)
    back, on = (_counterpart(probe, fixed._replace(value=value)) for value in (1 - wanted, 1))
    for part in parts:
        device.restore_after_body[probe.command.name] = partial(_request_all, probe, on)
        _request_all(probe, back)
        request_change(probe, part)
        call = f"{probe.command.name}({arguments_of(part)})"
        for other in parts:
            case, right = (EFFECT, wanted) if other == part else (NEIGHBOURS, 1 - wanted)
            _expect(probe, case, fixed, fixed.for_part(other), right, call)
        if not wanted and every is not None and every.query is not fixed.query:
            query, call = every.query.request_type(), f"{call}, while the others are on"
            _expect(probe, EFFECT, every, query, 0, call)


def _counterpart(probe: Probe, fixed: Fixed) -> Command:
    """Return the command that sets the value of one joint which a query reports."""
    for command in probe.device.table.commands:
        if _part_of(probe.device.table, command) == fixed:
            return command
    raise NotSupported("no command sets the opposite state")


def _request_all(probe: Probe, command: Command) -> None:
    for part in harmless(command):
        probe.device.request(part)


def _calibration(table: Table, command: Command) -> Fixed | None:
    """Return the fixed effect of a command that outlives a power cycle."""
    return fixed_effect(table, command) if command.safety == "persistent write" else None


def _calibrate(probe: Probe, fixed: Fixed) -> None:
    """Calibrate away from zero: each joint that the command can name, while the others stay."""
    device, query = probe.device, fixed.query
    if not probe.command.request[-1].fields:
        probe.drop(NEIGHBOURS)
    if device.permissions.workspace:
        mover = Mover(device)
        mover.go(mover.pose(0))
        _set_off(probe, mover, query)
    for part in harmless(probe.command):
        every = requests(query, query.request[-1])
        before = {other: fixed.read(device, other) for other in every}
        request_change(probe, part)
        call = f"{probe.command.name}({arguments_of(part)})"
        for other, value in before.items():
            mine = other.fields == part.fields
            case, right = (EFFECT, fixed.value) if mine else (NEIGHBOURS, value)
            _expect(probe, case, fixed, other, right, call)


def _set_off(probe: Probe, mover: Mover, query: Command) -> None:
    """Move what is calibrated, such as a gripper, away from its zero, if a motion sets it."""
    device, position = probe.device, query.request_type
    for command in device.table.commands:
        if command.safety == "motion" and not command.role and command.request[0].fields[1:]:
            for motion in settings_of(device.table, command):
                if motion.query is query and not motion.query_variant.fields:
                    old = device.require(position())
                    device.request(motion.samples(position(), old, mover.speed)[0])
                    mover.settle(lambda: device.read(position()))
                    return


def choices(table: Table, command: Command) -> list[tuple[Request[Any], Fixed]]:
    """Return a request for each choice of an argument that queries report, such as OPEN."""
    effect = stated_effect(command)
    if not isinstance(effect, Cases) or command.safety not in ("setting", "persistent write"):
        return []
    arguments = gentle_values(command.request[0])
    return [
        (command.request_type.from_fields(arguments | {effect.selector: raw}), fixed)
        for raw, case in effect.cases.items()
        if isinstance(case, Sets)
        for state, value in case.values.items()
        for found in reporters(table, state)
        if found.at == case.at and isinstance(value, int)
        for fixed in [Fixed(found.query, found.field, int(value))]
    ]


def _choose(probe: Probe, rows: list[tuple[Request[Any], Fixed]]) -> None:
    """Send each choice twice, one after another, so that each follows a different one.

    Then restore the old state.
    """
    device = probe.device
    for query, fixed in {fixed.for_part(request): fixed for request, fixed in rows}.items():
        old = fixed.read(device, query)
        back = [one for one, each in rows if (each.for_part(one), each.value) == (query, old)]
        if back:
            device.restore_after_body[str(query)] = partial(device.request, back[0])
        elif "irreversible" not in device.permissions.classes:
            raise NotSupported("no choice restores it: that needs the permission irreversible")
    for request, fixed in (*rows, *rows):
        request_change(probe, request)
        reads = partial(_read, device, fixed, fixed.for_part(request))
        device.poll(reads, fixed.value.__eq__, SHOWS, SHOWS / 4)
        call = f"{probe.command.name}({arguments_of(request)})"
        _expect(probe, EFFECT, fixed, fixed.for_part(request), fixed.value, call)


SWITCHES = Group(
    "switches",
    (EFFECT, DONE, *AFTER_CHANGE_OR_REPLY, REPEATS),
    *for_found(_switch_of, _switch),
    sends=(
        "The command that sets the opposite state, then the command itself, then the one "
        "that restores the state. Without power, each query without arguments, twice."
    ),
    subject="each command with a fixed effect that a query reports",
)
CHOICES = Group(
    "choices",
    (EFFECT, *AFTER_CHANGE_OR_REPLY),
    *for_found(choices, _choose),
    sends="The command with each choice in turn, twice; after each, the query that reports it.",
    subject="each setting with an argument that chooses a fixed effect which a query reports",
)
HOLDING = Group(
    "switched joints",
    (EFFECT, NEIGHBOURS, *AFTER_CHANGE),
    *for_found(_part_of, _switch_each),
    sends="The opposite state for all joints, then the command for each joint in turn.",
    subject="each command that switches one joint, if a query reports the state of each",
)
CALIBRATION = Group(
    "calibrations",
    (EFFECT, NEIGHBOURS, *AFTER_CHANGE_OR_REPLY),
    *for_found(_calibration, _calibrate),
    frozenset({"irreversible"}),
    sends="The calibration, at a pose that is not zero: for each joint that it can name.",
    subject="each command that permanently assigns a fixed value to the present position",
)
