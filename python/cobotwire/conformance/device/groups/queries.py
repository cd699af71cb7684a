"""Every query, with every set of arguments that may reveal a mistake."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.mover import give_power
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import Known, as_row, limits_of, requests
from cobotwire.conformance.device.response import ReceivedReply, Response
from cobotwire.conformance.hex_text import shown
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.diagnose.nuls import Nuls
from cobotwire.protocol.addresses import address_name
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Field, Table

UNKNOWN_ROW = "the device does not report the position that the query takes"
# Between two requests a value with a unit may move by this share of its range.
DRIFT = 0.02
# The time after power on until the readings of an arm must be steady, in seconds.
SETTLES = 1.0
# If this many replies in a row come with NULs, the arm sends them regularly.
NOISY = 10
# The name of the permission, and of the state that is restored.
POWER = "power"


def _echoes(command: Command) -> bool:
    return any(field.echo for variant in command.reply for field in variant.fields)


def _is_framed(command: Command) -> bool:
    return bool(command.reply)


REPLIED = TestCase("query-replied", "A query is replied to within its deadline.", timed=True)
FRAME = TestCase(
    "reply-frame",
    "A reply is a whole frame: header, address, LEN, id, footer as the edition defines them.",
    applies=_is_framed,
)
FIELDS = TestCase("reply-fields", "Each field of a reply holds a value that the edition allows.")
ECHO = TestCase(
    "reply-echo", "A reply repeats the arguments that the edition says it repeats.", applies=_echoes
)
ONCE = TestCase(
    "reply-once", "A query is replied to once; nothing follows the reply, and no NUL is part of it."
)
REPEATS = TestCase(
    "reply-repeats", "A query that is repeated while nothing changes has the same reply."
)


def is_query(table: Table, command: Command) -> bool:
    """Return whether a command is a query that must be replied to."""
    return command.safety == "query" and command.requires_reply


def _query(probe: Probe) -> None:
    """Send the query with each set of arguments, and the last request again."""
    command, every = probe.command, _every(probe)
    for query in every:
        first = probe.device.request(query)
        _check(probe, first)
    again = probe.device.request(every[-1])
    _check(probe, again)
    if _has_nuls(first) and _has_nuls(again):
        noisy = all(_has_nuls(probe.device.request(every[-1])) for _ in range(NOISY))
        reason = f"{command.name}: expected only the reply; each time received {again.summary}"
        probe.expect(ONCE, not noisy, reason)
    if first.valid is not None and again.valid is not None:
        expect_repetition(probe, probe.command, first.valid, again.valid)
    if command.name in probe.device.noticed.retried:
        probe.note(REPLIED, "A reply came, but only when the query was repeated.")


def _has_nuls(response: Response) -> bool:
    """Return whether a reply came with NULs, as happens now and then on a noisy line."""
    return any(isinstance(finding, Nuls) for finding in response.noise)


def _every(probe: Probe) -> list[Request[Any]]:
    """Return the query with each set of arguments.

    Raises:
        NotSupported: it takes a position that the device does not report.
    """
    known = probe.device.known(probe.command)
    every = [query for query in requests_of(probe.command, known) if _has_joint(probe, query)]
    if not every:
        raise NotSupported(UNKNOWN_ROW)
    return every


def requests_of(command: Command, known: Known) -> list[Request[Any]]:
    """Return a query with each set of arguments; ``known`` is the known position of the arm."""
    return [
        query
        for variant in command.request
        for query in requests(command, variant, known, limits_of(command, variant))
    ]


def is_framed_query(table: Table, command: Command) -> bool:
    """Return whether a command is a query with a framed reply."""
    return is_query(table, command) and bool(command.reply)


def _is_powered_query(table: Table, command: Command) -> bool:
    """Return whether a command is a framed query, and another command switches the power."""
    switchable = any(other.safety == "power" for other in table.commands)
    return switchable and is_framed_query(table, command)


def _query_with_power(probe: Probe) -> None:
    """Send the query twice after power on: a device whose first reply shows the old state fails."""
    device = probe.device
    was_off = POWER not in device.restore_at_end
    give_power(device)
    if was_off and POWER in device.restore_at_end:
        device.connection.clock.sleep(SETTLES)
    if not request_twice(probe, _every(probe)[-1]):
        raise NotSupported(f"{probe.command.name} reports nothing")


def request_twice(probe: Probe, query: Request[Any]) -> bool:
    """Compare the replies to a query and its repetition; return whether both are valid."""
    first = probe.device.request(query).valid
    again = first and probe.device.request(query).valid
    if first is None or again is None:
        return False
    expect_repetition(probe, probe.device.table.command(query.command), first, again)
    return True


def sample_of(device: Device, command: Command) -> Request[Any]:
    """Return the first request of a query.

    Raises:
        NotSupported: it takes a position that the device does not report.
    """
    found = requests(command, command.request[0], device.known(command))
    if not found:
        raise NotSupported(UNKNOWN_ROW)
    return found[0]


def _has_joint(probe: Probe, query: Request[Any]) -> bool:
    """Return whether the device has the joint that a query names; some have fewer joints."""
    device = probe.device
    fewer = device.joints < device.table.joints
    return not fewer or query.fields.get("joint", 1) <= device.joints


def _check(probe: Probe, response: Response) -> None:
    command = response.request.command
    call = probe.device.requester.describe(response.request)
    for damaged in response.damaged:
        expected = _expected_frame(probe.device.table, response)
        probe.expect(FRAME, False, f"{call}: {expected}; received {shown(damaged.data)}")
    if response.unexpected and not response.replies and not response.damaged and command.reply:
        expected = _expected_frame(probe.device.table, response)
        probe.expect(FRAME, False, f"{call}: {expected}; received {response.summary}")
    for reply in response.replies:
        probe.expect(FRAME, True, "")
        error = reply.error
        probe.expect(FIELDS, error is None, f"{call}: expected legal values; {error}")
        echoed = response.accepts(reply) or error is not None
        probe.expect(ECHO, echoed, _wrong_echo(call, response, reply))
    if response.replies:
        once = len(response.replies) == 1 and not response.unexpected
        probe.expect(
            ONCE, once, f"{call}: expected one reply and no more; received {response.summary}"
        )
    deadline = command.deadline_ms
    in_time = bool(response.replies) and not response.late
    probe.expect(REPLIED, in_time, _late(call, response, deadline))


def _expected_frame(table: Table, response: Response) -> str:
    frame, command = table.frame, response.request.command
    lengths = " or ".join(f"{frame.length(each.size, 'reply'):02X}" for each in command.reply)
    id = f", id {command.id:02X}" if frame.reply_has_id else ""
    header = f"{shown(frame.header)}{_expected_address(table, response)}"
    return f"expected a whole frame with the header {header}{id} and LEN {lengths}"


def _expected_address(table: Table, response: Response) -> str:
    """Return the address that a reply must have; nothing if frames have none."""
    replier = response.request.replier
    if replier is None:
        return ""
    if replier in table.frame.addresses:
        return f", address {replier:02X} ({address_name(table, replier)})"
    return ", the address of a device that has all joints that the request names"


def _wrong_echo(call: str, response: Response, reply: ReceivedReply) -> str:
    received = reply.decoded.fields if reply.decoded else {}
    sent = {name: v for name, v in response.request.arguments.items() if name in received}
    return f"{call}: expected the echo of {sent}; received {received}"


def _late(call: str, response: Response, deadline: int) -> str:
    received = f"received {response.summary}"
    if response.replies:
        received = f"the reply came after {1000 * response.replies[0].seconds:.0f} ms"
    return f"{call}: expected a reply within {deadline} ms; {received}"


def expect_repetition(
    probe: Probe, query: Command, first: ReceivedReply, again: ReceivedReply
) -> None:
    """Compare the replies to two equal requests, one right after the other."""
    if first.decoded is None or again.decoded is None:
        reason = f"{query.name}: expected the same text again; received {first.message}, then "
        probe.expect(REPEATS, first.message == again.message, f"{reason}{again.message}")
        return
    old, new = first.decoded.fields, again.decoded.fields
    reason = f"{query.name}: expected the same variant of reply; received {old}, then {new}"
    probe.expect(REPEATS, old.keys() == new.keys(), reason)
    for field in again.decoded.variant.fields:
        if field.name not in old:
            continue
        before, after = old[field.name], new[field.name]
        what = f"{query.name}: {field.name}"
        reason = f"{what}: expected the same again; received {before}, then {after}"
        probe.expect(REPEATS, _alike(field, before, after), reason)


def _alike(field: Field, before: object, after: object) -> bool:
    """Return whether two values are the same; a measured one, with a unit, may move a little."""
    if before == after:
        return True
    for number, one, other in zip(field.cases[0].numbers, as_row(before), as_row(after)):
        span = number.physical(number.maximum - number.minimum)
        if one != other and not (number.unit and abs(one - other) <= DRIFT * span):
            return False
    return True


QUERIES = Group(
    "queries",
    (REPLIED, FRAME, FIELDS, ECHO, ONCE, REPEATS),
    _query,
    is_query,
    sends=(
        "The query with each value of an argument, or with both ends of a long range; the last "
        "request twice."
    ),
    subject="each query",
)
WITH_POWER = Group(
    "queries with power",
    (REPEATS,),
    _query_with_power,
    _is_powered_query,
    frozenset({POWER}),
    sends="The query twice, after the arm has been switched on if it was off.",
    subject="each query with a framed reply, if a command switches the power",
)
