"""An arm that always sends the same replies, so that only the line changes what a client reads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cobotwire import codec as codecs
from cobotwire.codec.interface import Noise
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import DeviceSession, RequestReceived
from cobotwire.session.device import MalformedRequest
from field_notes.case import ACK, ANGLES_READ

# 27.5 mm is 0x0113 on the wire: the reply contains an XOFF.
COORDS_READ = [27.5, -60.2, 250.0, -90.5, 1.25, -86.0]
REGISTER_READ = 1000

REPLIES: dict[str, Callable[[Mapping[str, Any]], Any]] = {
    "get_angles": lambda request: ANGLES_READ,
    "get_coords": lambda request: COORDS_READ,
    "is_power_on": lambda request: True,
    "get_encoder": lambda request: 1000 + request["joint"],
    "get_servo_data": lambda request: REGISTER_READ,
}


class SteadyArm:
    """A peer that records what it receives; a restart changes nothing.

    Attributes:
        frames: every frame that arrived.
        garbled: how many other bytes arrived.
    """

    wait = None

    def __init__(self) -> None:
        self.frames: list[bytes] = []
        self.garbled = 0
        self._session = DeviceSession(codecs.load(TABLE))

    def receive(self, data: bytes) -> bytes:
        """Reply to each request."""
        replies = b""
        for event in self._session.receive(data):
            if isinstance(event, Noise):
                self.garbled += len(event.data)
            elif isinstance(event, RequestReceived | MalformedRequest):
                self.frames.append(event.frame.data)
            if isinstance(event, RequestReceived):
                replies += self._reply(event)
        return replies

    def flush(self) -> bytes:
        """Return nothing: this arm replies at once."""
        return b""

    def _reply(self, received: RequestReceived) -> bytes:
        command, fields = received.message.command, received.message.fields
        if command.name not in REPLIES:
            return ACK.replace(b"\x10", bytes([command.id])) if command.ack else b""
        variant = next(variant for variant in command.reply if len(variant.fields) == 1)
        value = REPLIES[command.name](fields)
        return self._session.encode_reply(command.name, {variant.fields[0].name: value})
