"""Match requests and replies without I/O, clock or threads: bytes and times in, events out."""

from cobotwire.session.acks import PendingAck
from cobotwire.session.device import (
    DeviceSession,
    MalformedRequest,
    RequestReceived,
    TextReceived,
)
from cobotwire.session.events import (
    AckReceived,
    EchoReceived,
    EventReceived,
    LateReply,
    ReplyMatched,
    ReplyRejected,
    RequestExpired,
    SessionEvent,
    Traffic,
    UnexpectedFrame,
)
from cobotwire.session.exchange import Exchange
from cobotwire.session.pending import Pending, PendingRequest, RetryPolicy
from cobotwire.session.request import EncodedRequest

__all__ = [
    "AckReceived",
    "DeviceSession",
    "EchoReceived",
    "EncodedRequest",
    "EventReceived",
    "Exchange",
    "LateReply",
    "MalformedRequest",
    "Pending",
    "PendingAck",
    "PendingRequest",
    "ReplyMatched",
    "ReplyRejected",
    "RequestExpired",
    "RequestReceived",
    "RetryPolicy",
    "SessionEvent",
    "TextReceived",
    "Traffic",
    "UnexpectedFrame",
]
