"""Setting one thing changes nothing else that a query reads."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.device.requests import arguments_of
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Reply, Request

OTHERS = TestCase("others-stay", "A setting changes nothing but what it sets.")


class _Spot(NamedTuple):
    """What a setting sets, for its first joint, pin or register: two values, and the old one."""

    query: Request[Any]
    first: Request[Any]
    second: Request[Any]
    old: Request[Any]

    def __str__(self) -> str:
        return f"{self.query.command}({arguments_of(self.query)})"


def _others_stay(probe: Probe) -> None:
    """Give each setting a value that is not its default; change one after the other."""
    device = probe.device
    spots: dict[str, _Spot] = {}
    for command in device.table.commands:
        # Of two settings that the same query reads, one is enough.
        if command.safety == "setting" and command.read_by is not None:
            for setting in settings_of(device.table, command)[:1]:
                spot = _spot(device, setting)
                if spot is not None:
                    spots.setdefault(spot.query.command, spot)
    if len(spots) < 2:
        raise NotSupported("fewer than two settings can be read back")
    for name, spot in spots.items():
        device.restore_after_body[name] = partial(device.request, spot.old)
        device.request(spot.first)
    before = {spot: device.read(spot.query) for spot in spots.values()}
    for spot in spots.values():
        _change(probe, spot, before)


def _spot(device: Device, setting: Setting) -> _Spot | None:
    """Return what to set; None if it cannot be read, set again, or set to two values."""
    query = setting.queries[0]
    reply = device.read(query)
    if reply is None:
        return None
    old = setting.again(query, reply)
    try:
        device.requester.prepare(old)
    except UsageError:
        return None
    # The last samples are the nearest to zero.
    others = [sample for sample in reversed(setting.samples(query, reply)) if sample != old]
    if len(others) > 1:
        return _Spot(query, others[0], others[1], old)
    return _Spot(query, others[0], old, old) if others else None


def _change(probe: Probe, spot: _Spot, before: dict[_Spot, Reply[Any] | None]) -> None:
    device = probe.device
    device.request(spot.second)
    changed = [
        f"{other} from {_plain(value)} to {_plain(now)}"
        for other, value in before.items()
        if other is not spot and value is not None
        if (now := device.read(other.query)) != value
    ]
    call = f"{spot.second.command}({arguments_of(spot.second)})"
    probe.expect(OTHERS, not changed, f"{call} also changes {'; '.join(changed)}")
    # What has changed with it is set again.
    for each in before if changed else (spot,):
        device.request(each.first)


def _plain(reply: Reply[Any] | None) -> str:
    if reply is None:
        return "no reply"
    return ", ".join(f"{name} {value}" for name, value in reply.fields.items())


COUPLING = Group(
    "settings among each other",
    (OTHERS,),
    _others_stay,
    permission=frozenset({"setting"}),
    sends="Two values for each setting, one after the other; all other settings are read.",
    subject="the line as a whole",
)
