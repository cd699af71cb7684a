"""The conversation without a port, clock or thread: bytes and times in, events out."""

from cobotwire.session.device import Asked, DeviceSession, Malformed, Told
from cobotwire.session.host import Answered, Expired, HostSession, Refused, SessionEvent, Unasked

__all__ = [
    "Answered",
    "Asked",
    "DeviceSession",
    "Expired",
    "HostSession",
    "Malformed",
    "Refused",
    "SessionEvent",
    "Told",
    "Unasked",
]
