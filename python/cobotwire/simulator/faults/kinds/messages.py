"""Faults that send legal messages which do not answer the request, and then the reply."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.faults.exchange import Piece, Reply, followed_by, joined
from cobotwire.simulator.faults.fault import Context, Fault
from cobotwire.simulator.faults.registry import kind
from cobotwire.simulator.faults.rules import SECONDS, ruled


@kind("event")
@dataclass(frozen=True, slots=True, kw_only=True)
class UnrequestedEvent(Fault):
    """An event of the edition comes before the reply.

    Attributes:
        seconds: the pause between the event and the reply.
    """

    seconds: float = ruled(SECONDS, 0.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Send one of the edition's events, then the reply."""
        events = events_of(context.table)
        if not events:
            return reply
        event = context.random.choice(events)
        address = context.frame.address(joined(reply)) if context.frame.addresses else None
        context.report(f"{event.name} before the reply")
        first = Piece(0.0, event_frame(context.table, event, address))
        return followed_by((first,), self.seconds, reply)


@kind("other-address")
@dataclass(frozen=True, slots=True, kw_only=True)
class OtherAddress(Fault):
    """A copy of the reply, with the address of another device, precedes the reply.

    Attributes:
        seconds: the pause between the two.
    """

    seconds: float = ruled(SECONDS, 0.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Send the reply of another device, then the reply."""
        frame, data = context.frame, joined(reply)
        own = frame.address(data) if frame.addresses else None
        others = [address for address in frame.addresses if address != own]
        if not others or context.request.id is None:
            return reply
        other = context.random.choice(others)
        context.report(f"the reply of address {other} before the reply")
        sent = frame.enclose(context.request.id, frame.data(data, "reply"), other, "reply")
        return followed_by((Piece(0.0, sent),), self.seconds, reply)


def events_of(table: Table) -> list[Command]:
    """Return the messages that the device sends without a request."""
    return [command for command in table.commands if command.event]


def event_frame(table: Table, event: Command, address: int | None) -> bytes:
    """Return an event of a device with a legal number near 1 in each field."""
    variant = event.reply[0]
    rows = [
        [next(iter(f.choices or n.choices), n.clamp(1)) for n in f.cases[0].numbers]
        for f in variant.fields
    ]
    return table.frame.enclose(event.id, variant.pack(rows), address, "reply")
