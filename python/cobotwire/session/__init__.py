"""The conversation without a port, clock or thread: bytes and times in, events out."""

from cobotwire.session.device import Asked, DeviceSession, Malformed, Told
from cobotwire.session.events import Answered, Echoed, Expired, Refused, SessionEvent, Unasked
from cobotwire.session.heard import Heard
from cobotwire.session.host import HostSession
from cobotwire.session.request import Request

__all__ = [
    "Answered",
    "Asked",
    "DeviceSession",
    "Echoed",
    "Expired",
    "Heard",
    "HostSession",
    "Malformed",
    "Refused",
    "Request",
    "SessionEvent",
    "Told",
    "Unasked",
]
