"""The arm does not move beyond the limits that are set for its joints."""

from __future__ import annotations

from functools import partial
from typing import Any

from cobotwire.conformance.device.groups.at_rest import is_limit
from cobotwire.conformance.device.groups.changes import request_change
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table

KEEPS = TestCase("limits-kept", "No joint moves beyond the limit that is set for it.")

# Where the limit and the target are, as shares of the joint's range in the workspace; and how far
# beyond the limit a joint may come to rest, in degrees.
LIMIT, TARGET, BEYOND = 0.04, 0.10, 1.0
# The pose from which the joints move.
POSE = 2


def _sets_limit(table: Table, command: Command) -> bool:
    """Return whether a command sets a limit of each joint, in degrees, that a query reads."""
    return command.safety in ("setting", "persistent write") and any(
        is_limit(table, setting.query) for setting in settings_of(table, command)
    )


def _keeps(probe: Probe) -> None:
    """Set a limit near the joint, and send the joint beyond it."""
    setting = settings_of(probe.device.table, probe.command)[0]
    # The first and the last joint; a firmware that keeps these limits keeps the others.
    for query in (setting.queries[0], setting.queries[-1]):
        _try(probe, setting, query)


def _try(probe: Probe, setting: Setting, query: Request[Any]) -> None:
    mover, device = Mover(probe), probe.device
    before = device.require(query)
    [joint] = query.values
    at = int(joint) - 1
    if at >= len(device.permissions.workspace):
        return
    mover.go(mover.pose(POSE))
    here, (low, high) = mover.angles(), device.permissions.workspace[at]
    way = (high - low) * (-1 if before.result < here[at] else 1)
    limit, target = round(here[at] + LIMIT * way), here[at] + TARGET * way
    [argument] = [argument for _, argument in setting.pairs]
    old = setting.again(query, before)
    device.restore_after_body[probe.command.name] = partial(device.request, old)
    request_change(probe, probe.command.request_type.from_fields({**old.fields, argument: limit}))
    device.request(mover.to((*here[:at], round(target, 2), *here[at + 1 :])))
    mover.wait()
    beyond = (mover.angles()[at] - limit) * (1 if way > 0 else -1)
    reason = (
        f"{probe.command.name}(joint {joint}) set the limit to {limit} degrees; sent to "
        f"{target:.1f}, the joint went {beyond:.1f} degrees beyond the limit"
    )
    probe.expect(KEEPS, beyond <= BEYOND, reason)
    device.request(old)


LIMITS_KEPT = Group(
    "limits kept",
    (KEEPS,),
    _keeps,
    _sets_limit,
    frozenset({"motion"}),
    sends="A limit near the first and the last joint, and a motion beyond it; then the old limit.",
    subject="each command that sets a limit of the joints which a query reads",
)
