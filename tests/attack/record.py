"""What users and transports write down during a run; the validator reads it afterwards."""

from __future__ import annotations

import itertools
import socket
import threading
import time
from contextlib import AbstractContextManager
from typing import Any, Literal, NamedTuple

from cobotwire.transport import OpenedTransport, open_transport
from cobotwire.transport.descriptor import DescriptorTransport

Ending = Literal["value", "error", "interrupted", "exception", "lost"]
SMALL_BUFFER = 1024


class Call(NamedTuple):
    """A call that has ended, or was given up as lost.

    Attributes:
        number: its position in the order in which calls began, from 1.
        user: the thread or task that called.
        name: the command.
        request: the bytes of its request.
        ack_within: the seconds that it waits for an acknowledgement; None: it does not.
        query: whether it has a reply.
        began: when it began.
        ended: when it ended.
        ending: how it ended.
        value: its result, or the text of the error.
    """

    number: int
    user: int
    name: str
    request: bytes
    ack_within: float | None
    query: bool
    began: float
    ended: float
    ending: Ending
    value: Any

    def __str__(self) -> str:
        took = f"{self.began:.3f} to {self.ended:.3f}"
        return f"#{self.number} user {self.user} {self.name} {took} s: {self.ending} {self.value!r}"


class Record:
    """Everything that the side of the client knows about a run. Threads may share it.

    Attributes:
        calls: the calls that have ended.
        running: the calls that have not, by user.
        handed: the time before each write, and its bytes.
        taken: the time after each write that was taken whole, and its bytes.
        bytes_taken: how many bytes the system has taken.
        filling: a lock that the run holds while it fills the line, so that no byte of the filling
            is inside a request.
        measured: when the call of each thread began and ended, as a client in another process
            measured it.
    """

    def __init__(self) -> None:
        self.calls: list[Call] = []
        self.running: dict[int, Call] = {}
        self.handed: list[tuple[float, bytes]] = []
        self.taken: list[tuple[float, bytes]] = []
        self.bytes_taken = 0
        self.numbers = itertools.count(1)
        self.filling: AbstractContextManager[Any] = threading.Lock()
        self.measured: dict[int, tuple[float, float]] = {}

    def begin(
        self, user: int, name: str, request: bytes, ack_within: float | None, query: bool
    ) -> Call:
        """Note that a call begins."""
        now = time.monotonic()
        call = Call(
            next(self.numbers), user, name, request, ack_within, query, now, now, "lost", None
        )
        self.running[user] = call
        return call

    def end(self, call: Call, ending: Ending, value: Any) -> None:
        """Note that a call has ended, unless it was given up as lost."""
        if self.running.pop(call.user, None) is not call:
            return
        here = (call.began, time.monotonic())
        began, ended = self.measured.pop(threading.get_ident(), here)
        self.calls.append(call._replace(began=began, ended=ended, ending=ending, value=value))

    def give_up(self) -> None:
        """Count the calls that still run as lost."""
        for call in tuple(self.running.values()):
            self.end(call, "lost", None)

    def note_write(self, line: dict[str, Any]) -> None:
        """Note a write of a client in another process, which uses the same clock."""
        data = bytes.fromhex(line["data"])
        self.handed.append((line["handed"], data))
        self.bytes_taken += line["size"]
        if line["size"] == len(data):
            self.taken.append((line["taken"], data))

    def note_times(self, began: float, ended: float) -> None:
        """Note when the call of this thread began and ended in another process."""
        self.measured[threading.get_ident()] = began, ended


def open_observed(url: str, baudrate: int, record: Record, *, small: bool) -> OpenedTransport:
    """Open a real transport whose writes are recorded as they are handed to the system.

    ``small``: give a socket the smallest buffer, so that a peer that reads nothing stalls it.
    """
    transport = open_transport(url, baudrate)
    assert isinstance(transport, DescriptorTransport), "ports and sockets have a descriptor"
    write_now, connect = transport._write_now, transport._connect

    def observed(data: bytes) -> int:
        record.handed.append((time.monotonic(), data))
        with record.filling:
            size = write_now(data)
        record.bytes_taken += size
        if size == len(data):
            record.taken.append((time.monotonic(), data))
        return size

    def connected() -> int:
        descriptor = connect()
        _shrink(transport, descriptor)
        return descriptor

    own = vars(transport)
    own["_write_now"] = observed
    if small:
        own["_connect"] = connected
        _shrink(transport, transport.fileno() or -1)
    return transport


def _shrink(transport: OpenedTransport, descriptor: int) -> None:
    if transport.kind == "socket":
        with socket.socket(fileno=socket.dup(descriptor)) as end:
            end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SMALL_BUFFER)
