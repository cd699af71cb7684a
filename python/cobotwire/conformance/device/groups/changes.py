"""The response to a request that changes something: none, an acknowledgement, or its reply."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.response import Response
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command

# Wait for a second acknowledgement only the first AWAITED times that a command is sent.
AWAITED = 4
# The value of an acknowledgement that reports success.
DONE = 1


def _is_silent(command: Command) -> bool:
    return not command.reply and command.text is None


def _may_be_acknowledged(command: Command) -> bool:
    return command.ack


def _is_replied_to(command: Command) -> bool:
    return command.requires_reply


SILENT = TestCase("one-way-silent", "A one-way request is not replied to.", applies=_is_silent)
ACKNOWLEDGED = TestCase(
    "acknowledgement",
    "At most one acknowledgement comes; it is legal and reports 1 (done).",
    applies=_may_be_acknowledged,
)
REPLIED = TestCase(
    "change-replied",
    "A change that has a reply is replied to once, legally and in time.",
    applies=_is_replied_to,
    timed=True,
)
ALIKE = TestCase(
    "acknowledgements-alike",
    "An arm that acknowledges one change acknowledges every change that may be acknowledged.",
)
# The test cases for the response to any change.
AFTER_CHANGE = (SILENT, ACKNOWLEDGED)
AFTER_CHANGE_OR_REPLY = (*AFTER_CHANGE, REPLIED)


def request_change(probe: Probe, request: Request[Any]) -> Response:
    """Send a request that changes something, and check the response."""
    response = probe.device.request(request)
    command = response.request.command
    call = probe.device.requester.describe(response.request)
    if command.requires_reply:
        _check_reply(probe, response, call)
    elif command.ack:
        _check_acknowledgement(probe, response, call)
    else:
        silent = not response.replies and not response.unexpected
        probe.expect(SILENT, silent, f"{call}: expected silence; received {response.summary}")
    return response


def _check_reply(probe: Probe, response: Response, call: str) -> None:
    device, deadline = probe.device, response.request.command.deadline_ms
    device.requester.listen(response, device.timing.silence)
    reason = f"{call}: expected one legal reply; received {response.summary}"
    probe.expect(REPLIED, response.only_valid, reason)
    if response.replies:
        took = 1000 * response.replies[0].seconds
        reason = f"{call}: expected the reply within {deadline} ms; it took {took:.0f} ms"
        probe.expect(REPLIED, not response.late, reason)


def _check_acknowledgement(probe: Probe, response: Response, call: str) -> None:
    device = probe.device
    if device.note_change(response) <= AWAITED:
        # A second acknowledgement may come a little later.
        device.requester.listen(response, device.timing.silence)
    at_most_one = len(response.replies) <= 1 and not response.unexpected
    done = all(
        reply.message is not None and all(v == DONE for v in reply.message.fields.values())
        for reply in response.replies
    )
    reason = (
        f"{call}: expected at most one acknowledgement, of value 1; received {response.summary}"
    )
    probe.expect(ACKNOWLEDGED, at_most_one and done, reason)


def _all_acknowledged(probe: Probe) -> None:
    """Compare all changes that were sent until now."""
    if not any(command.ack for command in probe.device.table.commands):
        probe.drop(ALIKE)
    probe.device.requester.await_acknowledgements()
    acknowledged = probe.device.noticed.acknowledged
    silent = [name for name, response in acknowledged.items() if not response.replies]
    if len(acknowledged) < 2:
        raise NotSupported("fewer than two changes were sent")
    reason = f"some commands were acknowledged, but not {', '.join(silent)}"
    probe.expect(ALIKE, not silent or len(silent) == len(acknowledged), reason)


ALL_ACKNOWLEDGED = Group(
    "all acknowledged",
    (ALIKE,),
    _all_acknowledged,
    sends="Nothing: the acknowledgements of the whole run are compared.",
    subject="the transport as a whole, if the edition has acknowledgements",
)
