"""Whether a reply belongs to a request. The protocol has no sequence numbers to tell."""

from __future__ import annotations

from cobotwire.codec.interface import DecodedMessage, Frame
from cobotwire.protocol.errors import ProtocolError
from cobotwire.session.request import EncodedRequest


def repeats_arguments(message: DecodedMessage, request: EncodedRequest) -> bool:
    """Return whether a reply of the request's command repeats the request's own arguments."""
    if not request.arguments:
        return True
    fields = message.fields
    repeated = [field.name for field in message.variant.fields if field.echo]
    return all(request.arguments.get(name, fields[name]) == fields[name] for name in repeated)


def can_reply_to(frame: Frame, request: EncodedRequest) -> bool:
    """Return whether a frame is a legal reply to a request that is no longer waited for."""
    if frame.command != request.command.id or frame.data == request.frame:
        # The request's own bytes may be only their echo, with the reply still to come.
        return False
    try:
        message = frame.decode("reply", of=request.command.name)
    except ProtocolError:
        return False
    return repeats_arguments(message, request)


def replies_differ(one: EncodedRequest, other: EncodedRequest) -> bool:
    """Return whether no reply to one request can be mistaken for a reply to the other."""
    command = other.command
    if one.command.id != command.id:
        return True
    if one.command.name != command.name or not command.reply:
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
