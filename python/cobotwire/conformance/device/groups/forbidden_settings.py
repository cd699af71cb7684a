"""A setting with a value that is not allowed changes nothing."""

from __future__ import annotations

from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.malformed import (
    MALFORMED,
    OUT_OF_RANGE,
    forbidden,
    wrong_values,
)
from cobotwire.conformance.device.malformed_sender import KEPT
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.hex_text import shown
from cobotwire.conformance.places import places
from cobotwire.conformance.suite import Group
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table


def _takes_forbidden_values(table: Table, command: Command) -> bool:
    """Return whether a setting that a query reads back can be sent a value that is not allowed."""
    return command.safety == "setting" and any(
        any(map(forbidden, places(setting.variant))) for setting in settings_of(table, command)
    )


def _forbidden(probe: Probe) -> None:
    """Set two values in turn; after each, send wrong values, and read that nothing changes.

    With two values, what a device takes a wrong value for differs from one of them.
    """
    device = probe.device
    for setting in settings_of(device.table, probe.command):
        query = setting.queries[0]
        before = device.require(query)
        old = setting.again(query, before)
        try:
            device.requester.prepare(old)
        except UsageError as error:
            raise NotSupported(f"the present value could not be set again: {error}") from None
        device.restore_after_body[probe.command.name] = partial(device.request, old)
        for present in setting.samples(query, before)[:2]:
            _try(probe, setting, query, present)
        device.request(old)


def _try(probe: Probe, setting: Setting, query: Request[Any], present: Request[Any]) -> None:
    device = probe.device
    device.request(present)
    encoded = device.requester.prepare(present)
    for what, listed, data in wrong_values(device.table, setting.variant, encoded.frame):
        # Another constant may mean another command.
        if device.requester.is_legal(data):
            continue
        response = device.requester.send_bytes(encoded, data, what, device.timing.silence)
        after = device.request(query)
        # A late reply comes after the query.
        silent = not (response.replies or response.unexpected or after.others)
        came = response.summary if response.replies or response.unexpected else after.summary
        probe.expect(OUT_OF_RANGE, silent, f"{what}: expected no reply; came {came}")
        reply = after.valid and after.valid.message
        wrong = setting.differences(present, reply)
        reason = f"{probe.command.name} with {what} ({shown(data)}) must change nothing"
        # A number beyond its range may be taken for the nearest legal one.
        limited = reply is not None and not listed
        probe.expect(KEPT, limited or not wrong, f"{reason}; {'; '.join(wrong)}")
        if wrong:
            device.request(present)


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
