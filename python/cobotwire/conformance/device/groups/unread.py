"""Commands that no query reads back: only the response is checked."""

from __future__ import annotations

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE_OR_REPLY, request_change
from cobotwire.conformance.device.groups.gripping import opens
from cobotwire.conformance.device.groups.motion import resume
from cobotwire.conformance.device.groups.recorded import appended, cleared
from cobotwire.conformance.device.groups.settings import is_shown
from cobotwire.conformance.device.groups.switching import choices
from cobotwire.conformance.device.mover import give_power
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import fixed_effect, setter_of, settings_of
from cobotwire.conformance.device.requests import gentle
from cobotwire.conformance.device.selection import has_role
from cobotwire.conformance.samples import ordinary, physical_values
from cobotwire.conformance.suite import Group
from cobotwire.protocol.table import Command, Table


def _is_unread(table: Table, command: Command) -> bool:
    """Return whether no query reads back what a command does, and no command restores it."""
    own = command.role in ("", "halt") or (command.role == "gripper" and not opens(table, command))
    read = (fixed_effect, settings_of, is_shown, choices, appended, cleared)
    return command.safety != "query" and own and not any(each(table, command) for each in read)


def _send_unread(probe: Probe) -> None:
    """Send the command once, with the arguments that change the least, and check the response."""
    power = probe.command.safety == "power"
    if power:
        give_power(probe.device)
    request_change(probe, gentle(probe.command))
    powered = probe.device.command("powered")
    on = setter_of(probe.device.table, powered, 1) if power and powered else None
    if on is not None:
        # The command may have left the arm with power, but with joints that are not held.
        probe.device.request(on.request_type())
    stop = probe.device.command("stop")
    if probe.command.safety == "motion" and stop is not None:
        probe.device.request(stop.request_type())
        resume(probe)


def _send_colours(probe: Probe) -> None:
    """Send colours that differ in red, green and blue, the darkest last; check the responses."""
    variant = probe.command.request[0]
    for turn in (0, 7):
        values = physical_values(variant, ordinary(variant, turn=turn))
        request_change(probe, probe.command.request_type.from_fields(values))
    request_change(probe, gentle(probe.command))


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
    has_role("light"),
    sends="Colours that differ in red, green and blue, the darkest last.",
    subject="each command with the role light",
)
