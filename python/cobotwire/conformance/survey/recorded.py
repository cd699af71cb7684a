"""Survey a recording: the queries that a program has to record, and the recorded arm."""

from __future__ import annotations

import time
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Any

from cobotwire.capture import Packet
from cobotwire.codec.interface import Codec
from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.queries import is_query, requests_of
from cobotwire.conformance.survey.interpreting import ids_of
from cobotwire.conformance.survey.survey import PRIVATE, SERIAL, states
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Table
from cobotwire.simulator import MemoryTransport, ReplayedArm, SteppedClock
from cobotwire.simulator.replayed import Exchange, exchanges

NOT_RECORDED = "the recording does not have this request"


def questions(table: Table) -> tuple[list[Request[Any]], dict[str, str]]:
    """Return the queries of level 1 in their order, and why each other query is not among them."""
    found, left_out = list[Request[Any]](), dict[str, str]()
    for command in sorted(table.commands, key=lambda each: not each.role):
        if command.event or not is_query(table, command):
            continue
        if (PRIVATE | SERIAL) & {*states(command)}:
            left_out[command.name] = "private"
        elif any(field.many for variant in command.request for field in variant.fields):
            left_out[command.name] = "takes a position"
        else:
            found += requests_of(command, {})
    return found, left_out


class RecordedTransport(MemoryTransport):
    """A transport to the arm of a recording, which replies as in the recording.

    A request that was not recorded raises NotSupported: silence would prove nothing.

    Attributes:
        began: when the recording began.
        missing: how many requests were not recorded.
    """

    def __init__(self, packets: Sequence[Packet], codec: Codec) -> None:
        began_ns = min(packet.time_ns for packet in packets)
        self.began = datetime.fromtimestamp(began_ns / 1e9, UTC)
        # If this survey is recorded, the new recording has the times of the old one.
        clock = SteppedClock((began_ns - time.time_ns() + time.monotonic_ns()) / 1e9)
        super().__init__(ReplayedArm(packets, codec, clock=clock), clock)
        self._recorded = _conclusive(exchanges(packets), codec)
        self.missing = 0

    def write(self, data: bytes) -> None:
        """Send a request that was recorded.

        Raises:
            NotSupported: it was not recorded.
        """
        if data not in self._recorded:
            self.missing += 1
            raise NotSupported(NOT_RECORDED)
        super().write(data)


def _conclusive(recorded: list[Exchange], codec: Codec) -> set[bytes]:
    """Return the requests for which a recording shows the reply, or that there was none.

    Silence proves nothing after the last request, or if the reply came after the next request.
    """
    while recorded and not recorded[-1].chunks:
        recorded.pop()
    ids = {each.request: ids_of(codec, "request", each.request) for each in recorded}
    replied, late = set[bytes](), set[int]()
    for request, chunks in recorded:
        came = ids_of(codec, "reply", b"".join(data for _, data in chunks))
        if came & ids[request]:
            replied.add(request)
        late |= came - ids[request]
    return {request for request, own in ids.items() if request in replied or not own & late}
