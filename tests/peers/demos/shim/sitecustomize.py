"""Redirect a demo to the simulated robot, whatever port it names, and shorten its sleeps."""

import os
import signal
import socket
import time
from typing import Any

PORT, TCP, RATE = os.environ["DEMO_PORT"], int(os.environ["DEMO_TCP"]), 20.0
_PORTS = ("/dev/ttyUSB", "/dev/ttyAMA", "/dev/ttyACM", "/dev/ttyS", "/dev/ttyTHS")
_open, _sleep, _connect = os.open, time.sleep, socket.socket.connect


def open_port(path: Any, *arguments: Any, **options: Any) -> int:
    """Open the simulated robot instead of a serial port that this machine does not have."""
    name = str(path)
    is_port = name.upper().startswith("COM") or name.startswith(_PORTS)
    return _open(PORT if is_port else path, *arguments, **options)


def connect(self: socket.socket, address: Any) -> None:
    """Connect to the simulated robot instead of a robot in the maker's network."""
    is_robot = isinstance(address, tuple) and str(address[0]).startswith("192.168.")
    _connect(self, ("127.0.0.1", TCP) if is_robot else address)


def sleep(seconds: float) -> None:
    """Sleep for less time, by the factor by which the simulated robot is faster."""
    _sleep(seconds / RATE)


# Ctrl-C ends a demo even if a background process started it; such processes ignore SIGINT.
signal.signal(signal.SIGINT, signal.default_int_handler)
for owner, name, function in (
    (os, "open", open_port),
    (socket.socket, "connect", connect),
    (time, "sleep", sleep),
):
    setattr(owner, name, function)

try:
    from serial.tools import list_ports
    from serial.tools.list_ports_common import ListPortInfo

    list_ports.comports = lambda *arguments: [ListPortInfo(PORT)]
except ImportError:
    pass
