"""The line of a case: a pty or TCP, with the case's faults between client and steady arm."""

from __future__ import annotations

import os
import termios
import time
import tty
from collections.abc import Iterator
from contextlib import contextmanager

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, Server, TcpServer
from cobotwire.simulator.faults import Scenario
from field_notes.case import Case
from field_notes.steady_arm import SteadyArm


class Line:
    """The URL that a client opens, and the frames that arrived at the other end."""

    def __init__(self, url: str, arm: SteadyArm) -> None:
        self.url = url
        self.arm = arm

    def settle(self) -> None:
        """Wait until no new bytes arrive for 60 ms, so that all that clients wrote has arrived."""
        received = -1
        while received != (received := len(self.arm.frames) + self.arm.garbled):
            time.sleep(0.06)


@contextmanager
def line_of(case: Case, transport: str) -> Iterator[Line]:
    """Serve the line of a case on a pty or over TCP."""
    arm = SteadyArm()
    if case.unread:
        with _unread_pty() as url:
            yield Line(url, arm)
        return
    peer = Scenario(name=case.name, faults=case.faults).wrap(arm, codecs.load(TABLE))
    server: Server = PtyServer(peer) if transport == "pty" else TcpServer(lambda: peer)
    if case.cooked and transport == "pty":
        _make_cooked(server.url)
    with server:
        yield Line(server.url, arm)


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
