"""Call the classes that open a TCP connection on a real server on loopback, in real time."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import cobotwire.pymycobot as ours
from cobotwire.simulator import SimulatedArm, TcpServer
from differences import Difference, part_of, rulings
from layer_comparison import (
    MISTAKE,
    REJECTED,
    Called,
    Compared,
    call_ours,
    call_theirs,
    conversation,
    result_of_ours,
    result_of_theirs,
    sample,
)
from pymycobot_classes import CLASSES
from robots.robot import Robot

# A call that takes longer in stepped time is compared there only.
LONGEST = 0.2
# How long a server may need to receive what was written.
ARRIVES = 1.0
LOOPBACK = "127.0.0.1"


class Kept:
    """The connection of a client to an arm; it keeps what arrives."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self.restart()

    def connect(self) -> Kept:
        return self

    def restart(self) -> None:
        """Put a new arm at the other end of the connection."""
        self.written = b""
        self._peer = SimulatedArm(self._robot.table, powered=True).connect()

    def receive(self, data: bytes) -> bytes:
        self.written += data
        reply: bytes = self._peer.receive(data)
        return reply

    def __getattr__(self, name: str) -> Any:
        return getattr(self._peer, name)


def compare_sockets(robot: Robot, which: int | str = 1) -> Compared:
    """Compare one call of methods of a class that opens a connection."""
    methods: set[str] = set()
    found: set[Difference] = set()
    # What differs in stepped time is ruled there.
    ruled = {
        each.method
        for each, reasons in rulings().items()
        if part_of(each) == "calls" and any(robot.peer in reason.names for reason in reasons)
    }
    with (
        _served(robot, CLASSES[robot.peer]) as (peer, at_peer),
        _served(robot, getattr(ours, robot.peer)) as (mine, at_mine),
    ):
        for call in sample(robot, which):
            if call.method in methods or call.method in ruled:
                continue
            stepped = call_theirs(robot, call), call_ours(robot, call)
            late = any(each.seconds > LONGEST or each.result is REJECTED for each in stepped)
            if late or conversation(robot, *stepped):
                continue
            methods.add(call.method)
            at_peer.restart()
            at_mine.restart()
            theirs = _called(at_peer, result_of_theirs(peer, call), stepped[0])
            called = _called(at_mine, result_of_ours(mine, call), stepped[1])
            # A machine that is busy for 0.3 s makes the library give up.
            gave_up = theirs.result in (None, -1) and theirs.result != stepped[0].result
            if not gave_up and (shows := conversation(robot, theirs, called)):
                found.add(Difference(call.method, "conversation", shows))
    return Compared(len(methods), methods, found)


class Ending:
    """A socket that ends the thread which reads it; the maker's own threads never end."""

    def settimeout(self, seconds: float) -> None:
        """Do nothing."""

    def recv(self, size: int) -> Any:
        return self

    def __bool__(self) -> bool:
        raise SystemExit

    def __ne__(self, other: object) -> bool:
        raise SystemExit


@contextmanager
def _served(robot: Robot, kind: Any) -> Iterator[tuple[Any, Kept]]:
    """Open a class on a server for a simulated arm."""
    kept = Kept(robot)
    with TcpServer(kept.connect) as server:
        opened = kind(LOOPBACK, int(server.url.rpartition(":")[2]))
        try:
            yield opened, kept
        finally:
            if hasattr(opened, "arm"):
                opened.arm.close()
            else:
                opened.sock, used = Ending(), opened.sock
                with suppress(OSError):
                    used.shutdown(socket.SHUT_RDWR)
                used.close()
                if hasattr(opened, "read_threading"):
                    opened.read_threading.join(ARRIVES)


def _called(kept: Kept, result: Any, stepped: Called) -> Called:
    """Return a call, once its server has received what it should, or does not in time."""
    end = time.monotonic() + ARRIVES
    while kept.written != stepped.written and time.monotonic() < end:
        time.sleep(0.001)
    return Called(kept.written, MISTAKE if result is REJECTED and kept.written else result)
