"""What a received frame can be, by pure functions; the protocol has no sequence numbers."""

from __future__ import annotations

from contextlib import suppress

from cobotwire.codec.interface import DecodedMessage, Frame
from cobotwire.protocol.addresses import ANYBODY, SOMEBODY
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.shared import once_per_table
from cobotwire.protocol.table import Command, Table, Variant
from cobotwire.session.events import EventReceived
from cobotwire.session.request import EncodedRequest


def can_come_from(address: int | None, request: EncodedRequest) -> bool:
    """Return whether a reply of this address can belong to the request."""
    return request.replier in (address, ANYBODY, SOMEBODY)


def repliers_meet(one: EncodedRequest, other: EncodedRequest) -> bool:
    """Return whether a reply of one address can belong to both requests."""
    repliers = (one.replier, other.replier)
    return one.replier == other.replier or ANYBODY in repliers or SOMEBODY in repliers


def repeats_arguments(message: DecodedMessage, request: EncodedRequest) -> bool:
    """Return whether a reply of the request's command repeats the request's own arguments."""
    if not request.arguments:
        return True
    fields = message.fields
    repeated = [field.name for field in message.variant.fields if field.echo]
    return all(request.arguments.get(name, fields[name]) == fields[name] for name in repeated)


def as_reply(
    frame: Frame, request: EncodedRequest, table: Table
) -> DecodedMessage | ProtocolError | None:
    """Decode a frame with the request's command id as its reply; do not compare repeated arguments.

    Returns:
        The reply; the error if the frame replies to the request with values that the edition does
        not allow; None if it replies to something else.
    """
    if request.replier is not None and not can_come_from(table.frame.address(frame.data), request):
        return None
    try:
        return frame.decode("reply", of=request.command.name)
    except ProtocolError as error:
        return None if replies_elsewhere(frame, request.command, table) else error


def can_reply_to(frame: Frame, request: EncodedRequest) -> bool:
    """Return whether a frame is a legal reply to a request that is no longer waited for."""
    if not request.can_have_reply(frame) or frame.data == request.frame:
        # The request's own bytes may be only their echo, with the reply still to come.
        return False
    try:
        message = frame.decode("reply", of=request.command.name)
    except ProtocolError:
        return False
    return can_come_from(message.address, request) and repeats_arguments(message, request)


@once_per_table
def _events(table: Table) -> dict[int, list[Command]]:
    """Return the commands that are events, by id."""
    events: dict[int, list[Command]] = {}
    for command in table.commands:
        if command.event:
            events.setdefault(command.id, []).append(command)
    return events


def as_event(frame: Frame, table: Table) -> EventReceived | None:
    """Return a frame as a message that the device sends without a request; None: it is not one."""
    for command in _events(table).get(frame.command, ()):
        with suppress(ProtocolError):
            return EventReceived(command, frame.decode("reply", of=command.name), frame)
    return None


def replies_elsewhere(frame: Frame, command: Command, table: Table) -> bool:
    """Return whether a frame replies to another command with the same id.

    The frame is not a legal reply of ``command``. A constant in the replies distinguishes commands
    that share an id, such as the register number of a device that the arm forwards to. The rest of
    the frame may be illegal.
    """
    data, has_id = table.frame.data(frame.data, "reply"), table.frame.reply_has_id
    others = [
        other
        for other in table.commands
        if (other.id == frame.command or not has_id) and other is not command and other.reply
    ]
    return bool(others) and not any(_has_constants(v, data) for v in command.reply)


def _has_constants(variant: Variant, data: bytes) -> bool:
    """Return whether data bytes can be this variant, as far as its constants show."""
    return variant.size == len(data) and all(
        field.allows(number, number.unpack(data, at))
        for at, (field, number) in variant.by_offset().items()
        if len(field.choices) == 1
    )


def _exclusive(one: Command, other: Command) -> bool:
    """Return whether no frame is a legal reply to both commands."""
    if not one.reply or not other.reply:
        # A text has no constants.
        return False
    return all(variant.excludes(known) for variant in one.reply for known in other.reply)


def replies_differ(one: EncodedRequest, other: EncodedRequest) -> bool:
    """Return whether no reply to one request can be mistaken for a reply to the other."""
    command = other.command
    if (one.reply_has_id and one.command.id != command.id) or not repliers_meet(one, other):
        return True
    if one.command.name != command.name:
        return _exclusive(one.command, command)
    if not command.reply:
        return False
    names = {
        name
        for name, value in one.arguments.items()
        if name in other.arguments and other.arguments[name] != value
    }
    # Older firmware leaves the repeated argument out, so every variant must tell them apart.
    return all(
        any(field.echo and field.name in names for field in variant.fields)
        for variant in command.reply
    )
