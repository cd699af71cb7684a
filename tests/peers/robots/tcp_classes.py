"""Make objects of the maker's class for the Pro 450, whose socket is a port in this process."""

from __future__ import annotations

import socket
from typing import Any

from pymycobot_classes import library
from pymycobot_ports import RecordingPort
from robots.crc_classes import SINGLE, ReadFrames, opened_as


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
    """The frames that the class has read. Return those that it accepted, and the rest."""

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
    """Return an object of a class that has a serial class beside it, with a socket instead."""
    peer = opened_as(SINGLE)(peer_class, port)
    del peer._serial_port
    peer.sock = PortSocket(port)
    return peer
