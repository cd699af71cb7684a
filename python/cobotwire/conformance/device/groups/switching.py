"""Commands that switch what a query reports, and commands that no query reads back."""

from __future__ import annotations

from functools import partial

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE_OR_REPLY, request_change
from cobotwire.conformance.device.groups.gripping import opens
from cobotwire.conformance.device.groups.motion import resume
from cobotwire.conformance.device.groups.queries import (
    REPEATS,
    SETTLES,
    expect_repetition,
    is_framed_query,
)
from cobotwire.conformance.device.groups.shown_among import is_shown
from cobotwire.conformance.device.mover import give_power
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import has_fixed_effect, settings_of
from cobotwire.conformance.device.requests import gentle, harmless
from cobotwire.conformance.samples import ordinary, physical_values
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Table


def _reports_done(command: Command) -> bool:
    """Return whether an acknowledgement reports that a command is done, not only accepted."""
    return command.ack and not command.accepted


DONE = TestCase(
    "acknowledged-done",
    "What an acknowledgement reports as done is what the query reports at once.",
    applies=_reports_done,
)
EFFECT = TestCase("effect", "The query reports the state that the command has set.")

# How long a switch may take to show, and how often it is read, in seconds.
SHOWS = 2.0
POLL = 0.05


def _is_switch(table: Table, command: Command) -> bool:
    """Return whether a query reports the fixed effect of a command, and it can be reverted."""
    return has_fixed_effect(command) and command.safety != "persistent write"


def _switch(probe: Probe) -> None:
    """Set the opposite state, then the command's own, then restore the old one."""
    command, device = probe.command, probe.device
    assert command.read_by is not None
    if command.safety == "power":
        give_power(device)
    query = device.table.command(command.read_by.query)
    name, wanted = command.read_by.fields[0]
    before = int(getattr(device.require(query.request_type()), name))
    back = device.setter(query, 1 - int(wanted)) if wanted in (0, 1) else None
    if back is None and before != wanted and "irreversible" not in device.permissions.classes:
        raise NotSupported("no command switches it back: that needs the permission irreversible")
    undo = back if before != wanted else command
    if undo is not None:
        device.restore_after_body[command.name] = partial(_send, probe, undo)
    if back is not None and before == wanted:
        _send(probe, back)
    acknowledged = _send(probe, command)
    value = _read(probe, query, name)
    if acknowledged:
        reason = f"{command.name} is acknowledged as done: expected {query.name} to report {wanted}"
        probe.expect(DONE, value == wanted, f"{reason} at once; came {value}")
    else:
        probe.drop(DONE)
    value = value if value == wanted else _await(probe, query, name, int(wanted))
    reason = f"{command.name}: expected {query.name} to report {wanted}; came {value}"
    probe.expect(EFFECT, value == wanted, reason)
    if command.safety != "power" or wanted:
        probe.drop(REPEATS)
    else:
        _expect_steady_replies(probe)


def _expect_steady_replies(probe: Probe) -> None:
    """Send each plain query twice: what was true with power shows in one reply."""
    device = probe.device
    device.connection.clock.sleep(SETTLES)
    for query in device.table.commands:
        if is_framed_query(device.table, query) and not query.request[0].fields:
            first = device.request(query.request_type()).valid
            again = first and device.request(query.request_type()).valid
            if first is not None and again is not None:
                expect_repetition(probe, query, first, again)


def _send(probe: Probe, command: Command) -> bool:
    """Send a command for each joint that it accepts; return whether each is acknowledged."""
    came = [bool(request_change(probe, request).replies) for request in harmless(command)]
    return command.ack and all(came)


def _read(probe: Probe, query: Command, name: str) -> int | None:
    reply = probe.device.read(query.request_type())
    return None if reply is None else int(getattr(reply, name))


def _await(probe: Probe, query: Command, name: str, wanted: int) -> int | None:
    """Poll a query until it reports ``wanted`` or the time is over; return its last value."""
    connection = probe.device.connection
    end = connection.now + SHOWS
    while True:
        value = _read(probe, query, name)
        if value == wanted or connection.now >= end:
            return value
        connection.clock.sleep(POLL)


def _is_unread(table: Table, command: Command) -> bool:
    """Return whether no query reads back what a command does, and no command restores it."""
    return (
        command.safety != "query"
        and (
            command.role in ("", "halt")
            or (command.role == "gripper" and not opens(table, command))
        )
        and not _is_switch(table, command)
        and not settings_of(table, command)
        and not is_shown(table, command)
        and not (command.read_by is not None and command.safety == "persistent write")
    )


def _send_unread(probe: Probe) -> None:
    """Send the command once, with the mildest arguments, and check what comes."""
    power = probe.command.safety == "power"
    if power:
        give_power(probe.device)
    request_change(probe, gentle(probe.command))
    powered = probe.device.command("powered")
    on = probe.device.setter(powered, 1) if power and powered else None
    if on is not None:
        # It may have left the arm with power, but with joints that are not held.
        probe.device.request(on.request_type())
    stop = probe.device.command("stop")
    if probe.command.safety == "motion" and stop is not None:
        probe.device.request(stop.request_type())
        resume(probe)


def _is_light(table: Table, command: Command) -> bool:
    """Return whether a command only sets the colour of a light, which need not be restored."""
    return command.role == "light"


def _send_colours(probe: Probe) -> None:
    """Send colours that differ in each part, the darkest last, and check what comes."""
    variant = probe.command.request[0]
    for turn in (0, 7):
        values = physical_values(variant, ordinary(variant, turn=turn))
        request_change(probe, probe.command.request_type.from_fields(values))
    request_change(probe, gentle(probe.command))


SWITCHES = Group(
    "switches",
    (EFFECT, DONE, *AFTER_CHANGE_OR_REPLY, REPEATS),
    _switch,
    _is_switch,
    sends=(
        "The command that sets the opposite state, then the command itself, then the one "
        "that restores the state. Without power, each query without arguments, twice."
    ),
    subject="each command with a fixed effect that a query reports",
)
UNREAD = Group(
    "unread commands",
    AFTER_CHANGE_OR_REPLY,
    _send_unread,
    _is_unread,
    frozenset({"irreversible"}),
    sends="The command once, with the arguments that change the least.",
    subject="each command that no query reads back",
)
LIGHTS = Group(
    "lights",
    AFTER_CHANGE_OR_REPLY,
    _send_colours,
    _is_light,
    sends="Colours that differ in each part, the darkest last.",
    subject="each command with the role light",
)
