"""The conversation without a port, clock or thread: bytes and times in, events out."""

from cobotwire.session.conversation import Conversation
from cobotwire.session.device import Asked, DeviceSession, Malformed, Told
from cobotwire.session.events import (
    Acknowledged,
    Answered,
    Echoed,
    Expired,
    Late,
    Refused,
    SessionEvent,
    Unasked,
)
from cobotwire.session.heard import Heard
from cobotwire.session.host import HostSession
from cobotwire.session.policy import RetryPolicy
from cobotwire.session.request import Request
from cobotwire.session.ticket import Order, Question, Ticket
from cobotwire.session.traffic import Traffic

__all__ = [
    "Acknowledged",
    "Answered",
    "Asked",
    "Conversation",
    "DeviceSession",
    "Echoed",
    "Expired",
    "Heard",
    "HostSession",
    "Late",
    "Malformed",
    "Order",
    "Question",
    "Refused",
    "Request",
    "RetryPolicy",
    "SessionEvent",
    "Ticket",
    "Told",
    "Traffic",
    "Unasked",
]
