"""Make objects of the maker's classes on a port in this process, also those that open a socket.

Classes whose frames end with a CRC read their port in a thread that never ends. Here no such thread
runs: the port is read when the class looks for a frame.
"""

from __future__ import annotations

import socket
import sys
import warnings
from collections.abc import Iterator
from functools import partial
from types import ModuleType
from typing import Any

from pymycobot_classes import library, peer_on
from pymycobot_ports import RecordingPort
from recorded_pins import Pins

# A port that is not one of the two arms of a Mercury B1 or X1; the class checks the port's name.
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


class PortSocket:
    """The part of a socket that the classes use."""

    # A class of the Mercury checks that it has a socket.
    __class__ = property(lambda self: socket.socket)

    def __init__(self, port: Any) -> None:
        self._port = port

    def fileno(self) -> int:
        return 3

    def settimeout(self, seconds: float) -> None:
        """Do nothing: the port knows how long it waits."""

    def sendall(self, data: bytes) -> None:
        self._port.write(data)

    def recv(self, size: int) -> bytes:
        data: bytes = self._port.read(size)
        if not data:
            raise TimeoutError
        return data


class SteppedEvent:
    """Stand in for the event that the socket's reading thread sets: a wait lets the time pass."""

    def wait(self, seconds: float) -> None:
        from pymycobot import pro450_close_loop

        pro450_close_loop.time.sleep(seconds)

    def clear(self) -> None:
        """Do nothing: the event is never set."""


class SocketFrames(ReadFrames):
    """The frames that a class with a socket has read and accepted."""

    def _taken(self, frame: bytes) -> bool:
        taken, _ = self._peer._process_received(frame)
        return bool(taken)


def opened_on_socket(peer_class: str, port: Any) -> Any:
    """Return an object of the class with a socket that is a port in this process."""
    from pymycobot.pro450_close_loop import Pro450CloseLoop

    peer = object.__new__(library(peer_class))
    Pro450CloseLoop.__init__(peer)
    peer.language, peer.max_joint, peer.min_joint = "en_US", 0, 0
    peer.sock = PortSocket(port)
    if not isinstance(port, RecordingPort):
        peer.event = SteppedEvent()
        peer.read_command = SocketFrames(peer, port)
    return peer


def opened_by_client(peer_class: str, port: Any) -> Any:
    """Return an object of a TCP class with a serial counterpart; its socket is a port here."""
    peer = opened_as(SINGLE)(peer_class, port)
    del peer._serial_port
    peer.sock = PortSocket(port)
    return peer


def on_socket(peer_class: str, port: Any) -> Any:
    """Return an object of a class that opens a TCP connection and has frames without a CRC."""
    from pymycobot.common import read, write

    peer = peer_on(peer_class, None)
    peer.sock = PortSocket(port)
    if not hasattr(library(peer_class), "_write"):
        # The constructor of the class would set these attributes.
        peer._write = partial(write, peer, method="socket")
        peer._read = partial(read, peer, method="socket")
    return peer
