"""The arm ignores or rejects a malformed request, and replies to the next legal one.

Only queries are damaged, so that nothing changes even if the firmware accepts one.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from random import Random

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.queries import is_framed_query, sample_of
from cobotwire.conformance.device.malformed_sender import (
    KEPT,
    RECOVERS,
    MalformedSender,
    expect_one_reply,
)
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.hex_text import shown
from cobotwire.conformance.located import LocatedNumber, located_numbers
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, FrameFormat, Table, Variant
from cobotwire.session.request import EncodedRequest
from cobotwire.simulator.faults.noise import NOISE

# A request is sent in pieces until no pause exceeds LATE times the planned one, at most ATTEMPTS
# times.
ATTEMPTS, LATE = 3, 2
MALFORMED = frozenset({"malformed"})
# Classes of the simulator's catalogue: packets of the servo bus, text, and bytes of a header.
PACKETS = ("servo", "servo FE")
NOISES = (*PACKETS, "command error", "header bytes")

WRONG_LENGTH = TestCase("wrong-length", "A request with a wrong LEN is not replied to.")
WRONG_FOOTER = TestCase("wrong-footer", "A request with a wrong footer is not replied to.")
CUT = TestCase("cut-request", "An incomplete request is discarded when the line falls silent.")
OUT_OF_RANGE = TestCase("out-of-range", "A request with a value that is not allowed is ignored.")
UNKNOWN_ID = TestCase("unknown-id", "A request with an id that the edition lacks is ignored.")
NOISE_BEFORE = TestCase("noise-before", "A request after noise is replied to.")
TOGETHER = TestCase("two-in-one-write", "Requests in one write are all replied to, in order.")
IN_ORDER = TestCase(
    "replies-in-order",
    "Requests of different commands in one write are replied to in their order.",
)
PIECES = TestCase(
    "request-in-pieces", "A request in pieces with pauses is replied to like a whole one."
)


def _damaged(probe: Probe) -> None:
    """Send requests with a wrong LEN or footer, and requests that break off."""
    request = _sample(probe)
    sender = MalformedSender(probe, request)
    for case, what, data in _damages(probe.device.table.frame, request.frame):
        sender.send(case, what, data)


def _sample(probe: Probe) -> EncodedRequest:
    """Return the request to damage: the first sample."""
    return probe.device.requester.prepare(sample_of(probe.device, probe.command))


def _damages(frame: FrameFormat, data: bytes) -> Iterator[tuple[TestCase, str, bytes]]:
    """Yield a request damaged in each way: the test case, the description, the bytes."""
    length = frame.read_length(data)
    longer = frame.with_length(data, length + 1)
    yield WRONG_LENGTH, "LEN one too large", longer
    yield WRONG_LENGTH, "LEN one too small", frame.with_length(data, length - 1)
    end = len(data) - frame.check_size
    more = longer[:end] + b"\x00" + longer[end:]
    if frame.check is None:
        yield WRONG_LENGTH, "one data byte too many, and LEN with it", more
    yield WRONG_FOOTER, "a wrong footer", data[:-1] + bytes([data[-1] ^ 0xFF])
    yield CUT, "broken off before the footer", data[:-1]
    yield CUT, "broken off after LEN", data[: frame.length_at + frame.length_number.width]
    if end > frame.data_at:
        yield CUT, "broken off after the id", data[: frame.data_at]


def _can_be_out_of_range(table: Table, command: Command) -> bool:
    """Return whether bytes can express arguments that the edition does not allow."""
    return is_framed_query(table, command) and any(
        map(forbidden, located_numbers(command.request[0]))
    )


def _out_of_range(probe: Probe) -> None:
    """Send arguments that the edition does not allow."""
    request = _sample(probe)
    sender = MalformedSender(probe, request)
    variant = probe.command.request[0]
    for what, _, data in wrong_values(probe.device.table, variant, request.frame):
        # With another constant the frame may be a legal request of another command.
        if not probe.device.requester.is_legal(data):
            sender.send(OUT_OF_RANGE, what, data)


def wrong_values(table: Table, variant: Variant, data: bytes) -> Iterator[tuple[str, bool, bytes]]:
    """Yield requests with one number outside the range or list of its field.

    Each item is a description, whether the field has a list, and the frame.
    """
    frame, rest = table.frame, table.frame.data(data)
    id, address = frame.read_id(data), frame.address(data)
    for located in located_numbers(variant):
        at, width, listed = located.start, located.number.width, bool(located.field.choices)
        for value in forbidden(located):
            wrong = rest[:at] + value.to_bytes(width, located.number.order) + rest[at + width :]
            yield f"{located.name} = {value}", listed, frame.enclose(id, wrong, address)


def forbidden(located: LocatedNumber) -> list[int]:
    """Return values that a number without negative values does not allow.

    They are illegal even if the firmware reads them as signed.
    """
    choices, number = located.field.choices, located.number
    if number.minimum < 0:
        return []
    top = 256**number.width
    near = {number.minimum - 1, number.maximum + 1, top - 1, *(choice + 1 for choice in choices)}
    return sorted(v for v in near if 0 <= v < top and not located.field.allows(number, v))


def _crowded(probe: Probe) -> None:
    """Send legal requests in pieces, several at once, and after noise.

    Noise is sent last, because a device may lose the requests after it.
    """
    device, request = probe.device, _sample(probe)
    if not device.noticed.reply_seconds.get(probe.command.name) and not _is_replied_to(probe):
        raise NotSupported("the query has no reply, even when nothing else is sent")
    _in_pieces(probe, request)
    _together(probe, request)
    sender = MalformedSender(probe, request)
    for name in NOISES:
        # The same pieces in each run, so that reports can be compared.
        noise = NOISE[name].draw(Random(name), device.table)  # noqa: S311
        data, what = noise + request.frame, "noise and a request"
        response = device.count(device.requester.send_instead(request, data, what))
        expect_one_reply(probe, NOISE_BEFORE, response, f"the request after {shown(noise)}")
        # Text is left out: an arm may send "cmd_len error" by itself.
        copied = name in PACKETS and any(noise in finding.data for finding in response.findings)
        reason = f"the noise {shown(noise)} comes back: {response.summary}"
        probe.expect(NOISE_BEFORE, not copied, reason)
        again = partial(device.requester.send_instead, request, data, what)
        sender.expect_kept(f"noise {name!r}", data, again)


def _is_replied_to(probe: Probe) -> bool:
    return bool(probe.device.request(sample_of(probe.device, probe.command)).replies)


def _in_pieces(probe: Probe, request: EncodedRequest) -> None:
    """Send one byte at a time. Repeat it if the host was so late that a device may give up."""
    device, frame, longest = probe.device, request.frame, LATE * probe.device.timing.pause
    for _ in range(ATTEMPTS):
        start = device.connection.mark
        for at in range(len(frame) - 1):
            piece, pause = frame[at : at + 1], device.timing.pause
            half = device.requester.send_bytes(request, piece, "a piece", pause)
            probe.expect(PIECES, not half.replies, f"after half a request: received {half.summary}")
        response = device.requester.send_instead(request, frame[-1:], "the last piece")
        times = [each.at for each in device.connection.since(start) if each.direction == "sent"]
        pauses = [1000 * (after - before) for before, after in pairwise(times)]
        paused = f"Pauses of {min(pauses):.0f} to {max(pauses):.0f} ms"
        if response.only_valid or max(pauses) <= 1000 * longest:
            device.count(response)
            probe.note(PIECES, f"{paused}.")
            expect_one_reply(probe, PIECES, response, f"the request in pieces ({paused})")
            return
        device.connection.clock.sleep(device.timing.idle)
    probe.not_timed(PIECES, f"{paused}: the host was late, so a device may have given up.")


def _together(probe: Probe, request: EncodedRequest) -> None:
    """Send two requests in one write, and three."""
    device = probe.device
    for count in (2, 3):
        data, what = request.frame * count, f"{count} requests"
        response = device.count(device.requester.send_instead(request, data, what))
        if len(response.replies) < count:
            deadline = request.command.deadline_ms / 1000
            device.requester.listen(response, deadline)
        legal = [reply for reply in response.replies if response.accepts(reply)]
        complete = len(legal) == len(response.replies) == count and not response.unexpected
        reason = f"{what}: expected {count} replies; received {response.summary}"
        probe.expect(TOGETHER, complete, reason)


def _other(table: Table, command: Command) -> Command | None:
    """Return the other query without arguments that has the shortest deadline.

    None if the edition has no such query, or its replies do not name the command.
    """
    if not table.frame.reply_has_id or not is_framed_query(table, command):
        return None
    plain = (c for c in table.commands if is_framed_query(table, c) and not c.request[0].fields)
    others = [query for query in plain if query.id != command.id]
    return min(others, key=lambda query: query.deadline_ms, default=None)


def _ordered(probe: Probe, other: Command) -> None:
    """Send the query before another one, and after it."""
    device = probe.device
    first = sample_of(device, probe.command)
    # A query that has no reply fails another test case.
    device.require(first)
    mine, theirs = (device.requester.prepare(r) for r in (first, other.request_type()))
    for pair in ((mine, theirs), (theirs, mine)):
        names = " and ".join(each.command.name for each in pair)
        start = device.connection.mark
        data = pair[0].frame + pair[1].frame
        response = device.count(device.requester.send_instead(mine, data, names))
        if not response.replies or not response.others:
            deadline = max(mine.command.deadline_ms, theirs.command.deadline_ms) / 1000
            device.requester.listen(response, deadline)
        received = device.connection.received_since(start)
        right = [each.command.id for each in pair]
        frames = [reply.data for reply in response.replies] + [f.data for f in response.others]
        frames.sort(key=received.find)
        ids = [device.table.frame.read_id(frame) for frame in frames]
        reason = f"{names} in one write: expected a reply to each, in this order; received "
        reason += "; ".join(map(shown, frames)) or "nothing"
        if ids == right[::-1]:
            reason += ": in the other order"
        elif ids == right[:1]:
            reason += f": {pair[1].command.name} had no reply"
        probe.expect(IN_ORDER, ids == right, reason)


def _unknown_ids(probe: Probe) -> None:
    """Send ids that the edition lacks, with and without data."""
    table = probe.device.edition
    queries = (c for c in probe.device.table.commands if is_framed_query(table, c))
    carrier = next(query for query in queries if not query.request[0].fields)
    request = probe.device.requester.prepare(carrier.request_type())
    sender = MalformedSender(probe, request)
    for id in _free_ids(table):
        for data in (b"", b"\x01"):
            whole = table.frame.enclose(id, data, table.frame.address(request.frame))
            sender.send(UNKNOWN_ID, f"the unknown id {id:02X}", whole)
    sender.expect_all_kept()


def _free_ids(table: Table) -> list[int]:
    """Return some ids that no command has: the first, the last, and some between."""
    known = {command.id for command in table.commands}
    free = [id for id in range(256) if id not in known]
    return free[:1] + free[1:-1:24] + free[-1:]


DAMAGED = Group(
    "damaged requests",
    (WRONG_LENGTH, WRONG_FOOTER, CUT, RECOVERS, KEPT),
    _damaged,
    is_framed_query,
    MALFORMED,
    sends=(
        "The query with LEN one too large and too small, a data byte too many, a wrong "
        "footer, and broken off; after each, a good query."
    ),
    subject="each query with a framed reply",
)
FORBIDDEN = Group(
    "forbidden values",
    (OUT_OF_RANGE, RECOVERS, KEPT),
    _out_of_range,
    _can_be_out_of_range,
    MALFORMED,
    sends=(
        "The query with values next to the allowed ones, and the largest that the bytes can "
        "hold; after each, a good query."
    ),
    subject="each query with arguments that can be out of range",
)
CROWDED = Group(
    "crowded requests",
    (PIECES, TOGETHER, NOISE_BEFORE, KEPT),
    _crowded,
    is_framed_query,
    MALFORMED,
    sends=(
        "The query one byte at a time; twice and three times in one write; after packets of the "
        "servo bus, text and bytes of a header."
    ),
    subject="each query with a framed reply",
)
ORDERED = Group(
    "requests of two commands",
    (IN_ORDER,),
    *for_found(_other, _ordered),
    MALFORMED,
    sends="The query and another one in one write, in both orders.",
    subject="each query with a framed reply that has an id",
)
UNKNOWN_IDS = Group(
    "unknown ids",
    (UNKNOWN_ID, RECOVERS, KEPT),
    _unknown_ids,
    permission=MALFORMED,
    sends="Frames with ids that the edition lacks, with and without data.",
    subject="the transport as a whole",
)
