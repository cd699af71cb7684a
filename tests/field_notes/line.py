"""The line of a case: a pty or TCP, with the case's faults between client and arm."""

from __future__ import annotations

import os
import termios
import time
import tty
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from cobotwire import codec as codecs
from cobotwire.codec.interface import Noise
from cobotwire.editions.mycobot280 import TABLE, Angles, Coords
from cobotwire.editions.mycobot280.messages import (
    GetAngles,
    GetCoords,
    GetEncoder,
    GetServoData,
    IsPowerOn,
)
from cobotwire.session import RequestReceived
from cobotwire.session.device import DeviceEvent, MalformedRequest
from cobotwire.simulator import PtyServer, Server, SimulatedArm, TcpServer
from cobotwire.simulator.behaviour import Behaviours
from cobotwire.simulator.faults import Scenario
from field_notes.case import ANGLES_READ, Case

# 27.5 mm is 0x0113 on the wire: the reply contains an XOFF.
COORDS_READ = [27.5, -60.2, 250.0, -90.5, 1.25, -86.0]
REGISTER_READ = 1000

STEADY = Behaviours()
STEADY.query(GetAngles, lambda arm, now, request: Angles(*ANGLES_READ))
STEADY.query(GetCoords, lambda arm, now, request: Coords(*COORDS_READ))
STEADY.query(IsPowerOn, lambda arm, now, request: True)
STEADY.query(GetEncoder, lambda arm, now, request: 1000 + request.joint)
STEADY.query(GetServoData, lambda arm, now, request: REGISTER_READ)


def steady_arm(received: list[DeviceEvent]) -> SimulatedArm:
    """Return an arm with constant replies, so that only faults of the line change what a client
    reads.

    The arm adds what it receives to ``received``.
    """
    return SimulatedArm(
        TABLE, behaviours=STEADY, on_event=lambda event, reply: received.append(event)
    )


def frames_of(received: Sequence[DeviceEvent]) -> list[bytes]:
    """Return every frame that an arm received."""
    return [
        event.frame.data
        for event in received
        if isinstance(event, RequestReceived | MalformedRequest)
    ]


class Line:
    """The URL that a client opens, and what arrived at the other end."""

    def __init__(self, url: str, received: list[DeviceEvent]) -> None:
        self.url = url
        self._received = received

    @property
    def frames(self) -> list[bytes]:
        """Every frame that arrived."""
        return frames_of(self._received)

    @property
    def garbled(self) -> int:
        """How many other bytes arrived."""
        return sum(len(event.data) for event in self._received if isinstance(event, Noise))

    def settle(self, least: int = 0) -> None:
        """Wait until no new bytes arrive for 60 ms, so that all that clients wrote has arrived.

        The system may pass on the bytes of a pty later: wait up to 2 s for ``least`` frames.
        """
        received, until = -1, time.monotonic() + 2
        while received != (received := len(self.frames) + self.garbled) or (
            len(self.frames) < least and time.monotonic() < until
        ):
            time.sleep(0.06)


@contextmanager
def line_of(case: Case, transport: str) -> Iterator[Line]:
    """Serve the line of a case on a pty or over TCP."""
    received: list[DeviceEvent] = []
    if case.unread:
        with _unread_pty() as url:
            yield Line(url, received)
        return
    scenario = Scenario(name=case.name, faults=case.faults)
    peer = scenario.wrap(steady_arm(received), codecs.load(TABLE))
    server: Server = PtyServer(peer) if transport == "pty" else TcpServer(lambda: peer)
    if case.cooked and transport == "pty":
        _make_cooked(server.url)
    with server:
        yield Line(server.url, received)


@contextmanager
def _unread_pty() -> Iterator[str]:
    """Yield a pseudo-terminal that nothing reads."""
    master, slave = os.openpty()
    tty.setraw(slave)
    try:
        yield os.ttyname(slave)
    finally:
        os.close(master)
        os.close(slave)


def _make_cooked(url: str) -> None:
    """Put a pseudo-terminal into the mode of a new one."""
    fresh = os.openpty()
    port = os.open(url, os.O_RDWR | os.O_NOCTTY)
    termios.tcsetattr(port, termios.TCSANOW, termios.tcgetattr(fresh[1]))
    for descriptor in (port, *fresh):
        os.close(descriptor)
