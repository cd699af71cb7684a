"""Make objects of the maker's classes whose frames end with a CRC, on a port in this process.

These classes read their port in a thread that never ends. Here nothing runs beside the test: what
the thread would have read is read when the class looks for a frame.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from pymycobot_classes import library
from pymycobot_ports import RecordingPort
from recorded_pins import Pins

# A port that is not one of the two arms of a Mercury B1 or X1; the class asks for the name.
SINGLE = "/dev/ttyAMA1"


# The pins of the computer in a Pro 630 exist there only.
sys.modules.setdefault("RPi", ModuleType("RPi"))
sys.modules.setdefault("RPi.GPIO", Pins())


class ReadFrames(list[Any]):
    """The frames that a class has read, each with its time."""

    def __init__(self, peer: Any, port: Any) -> None:
        super().__init__()
        self._peer, self._port, self._data = peer, port, bytearray()

    def __iter__(self) -> Iterator[Any]:
        from pymycobot import close_loop

        self._data += self._port.read(self._port.inWaiting()) if self._port.inWaiting() else b""
        while len(self._data) > 2 and len(self._data) >= self._data[2] + 3:
            size = self._data[2] + 3
            frame, self._data = bytes(self._data[:size]), self._data[size:]
            if self._taken(frame):
                self.append([frame, close_loop.time.time()])
        return super().__iter__()

    def _taken(self, frame: bytes) -> bool:
        return bool(self._peer._process_received(frame))


def opened_as(name: str) -> Any:
    """Return a function that makes an object of a class, as if its port had that name."""

    def opened(peer_class: str, port: Any) -> Any:
        from pymycobot.close_loop import CloseLoop
        from pymycobot.mercury_api import MercuryCommandGenerator

        kind = library(peer_class)
        peer = object.__new__(kind)
        with warnings.catch_warnings():
            # pymycobot reads the locale in a way that Python deprecates.
            warnings.simplefilter("ignore")
            base = (
                MercuryCommandGenerator if issubclass(kind, MercuryCommandGenerator) else CloseLoop
            )
            base.__init__(peer)
        port.port = name
        # The Pro 630 explains how a motion ended, in one of two languages.
        peer.language = "en_US"
        peer._serial_port = port
        if not isinstance(port, RecordingPort):
            peer.read_command = ReadFrames(peer, port)
        return peer

    return opened
