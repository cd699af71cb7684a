"""The conformance statement of the device is true: absent commands are absent, its facts hold."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import saved_value, settings_of
from cobotwire.conformance.device.requests import harmless
from cobotwire.conformance.statement import Acknowledgements
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table

SOURCE = "the statement"
ABSENT = TestCase(
    "declared-absent", "A command that the statement declares absent is not replied to.", SOURCE
)
FIRMWARE = TestCase(
    "declared-firmware", "The device reports the firmware that the statement declares.", SOURCE
)
ACKNOWLEDGEMENTS = TestCase(
    "declared-acknowledgements", "Changes are acknowledged as the statement declares.", SOURCE
)


def _shows(table: Table, command: Command) -> bool:
    """Return whether a reply would show that a command is there, and sending it does no harm."""
    if command.safety == "query":
        return command.requires_reply
    return (command.requires_reply or command.ack) and bool(settings_of(table, command))


def _absent(probe: Probe) -> None:
    """Send the command, a setting with its present value, and expect no reply."""
    command, device = probe.command, probe.device
    shared = [
        other.name
        for other in device.table.commands
        if other.id == command.id and other is not command and not device.statement.lacks(other)
    ]
    if shared:
        raise NotSupported(f"{', '.join(shared)}, which is not declared absent, has the same id")
    request = harmless(command)[0] if command.safety == "query" else _present(probe)
    # Sent without being counted as an unanswered query, since silence is right here.
    response = device.requester.send(device.requester.prepare(request))
    reason = f"{command.name} is declared absent: expected no reply; received {response.summary}"
    probe.expect(ABSENT, not response.replies, reason)


def _present(probe: Probe) -> Request[Any]:
    """Return the request that sets the present value again.

    Raises:
        NotSupported: it cannot be read, or cannot be sent.
    """
    for setting in settings_of(probe.device.table, probe.command):
        for query in setting.queries:
            saved = saved_value(probe.device, setting, query)
            if saved is not None and not saved.obstacle:
                return saved.old
    raise NotSupported("the present value cannot be read, so no request would leave it unchanged")


def _facts(probe: Probe) -> None:
    """Compare the facts of the statement with the whole run."""
    device, statement = probe.device, probe.device.statement
    version = device.command("version")
    if not statement.firmware:
        probe.drop(FIRMWARE)
    elif version is not None:
        reported = str(device.require(version.request_type()).result)
        reason = f"expected {statement.firmware}, as declared; {version.name} reports {reported}"
        probe.expect(FIRMWARE, reported == statement.firmware, reason)
    declared = statement.acknowledgements
    if declared is Acknowledgements.UNKNOWN:
        probe.drop(ACKNOWLEDGEMENTS)
    for name, response in device.noticed.acknowledged.items():
        acknowledged = bool(response.replies)
        right = acknowledged is (declared is Acknowledgements.ALL)
        was = "was acknowledged" if acknowledged else "was not acknowledged"
        stated = "every change is" if declared is Acknowledgements.ALL else "no change is"
        reason = f"the statement declares that {stated} acknowledged; {name} {was}"
        probe.expect(ACKNOWLEDGEMENTS, right, reason)


DECLARED_ABSENT = Group(
    "declared absent",
    (ABSENT,),
    _absent,
    _shows,
    sends="The query, or the setting with its present value.",
    subject="each command that the statement declares absent, if a reply would prove it present",
    declared=True,
)
DECLARED_FACTS = Group(
    "declared facts",
    (FIRMWARE, ACKNOWLEDGEMENTS),
    _facts,
    sends="The query of the version; the acknowledgements of the whole run are compared.",
    subject="the facts of the statement",
    declared=True,
)
