"""One end of a pair of sockets, which exchanges requests by native calls."""

from __future__ import annotations

import os
import socket
import threading
import time
from types import SimpleNamespace
from typing import Any

from cobotwire import RetryPolicy
from cobotwire import codec as codecs
from cobotwire.client.steps import Steps
from cobotwire.client.traffic import TrafficListeners
from cobotwire.editions.mycobot import TABLE
from cobotwire.session import EncodedRequest, Exchange
from cobotwire.session.alone import Begun
from cobotwire.transport.interface import Loan
from cobotwire.transport.waiting import native_calls

REQUEST = bytes.fromhex("FE FE 02 20 FA")


class Swapping:
    """One end of a pair of sockets that exchanges requests; the test has the other end.

    It is the transport, and the caller of the native calls.
    """

    def __init__(self) -> None:
        self.ours, self.peer = socket.socketpair()
        self.ours.setblocking(False)
        self.alarm = os.eventfd(0)
        self.lock = threading.RLock()
        self.loan: Loan | None = Loan(
            self.lock.acquire, self.lock.release, self.ours.fileno(), self.alarm
        )
        self.codec: Any = codecs.load(TABLE, "native")
        self.exchange = Exchange(self.codec)
        listeners = TrafficListeners(None, "")
        unused: Any = SimpleNamespace()
        self.steps = Steps(unused, self.exchange, listeners, time.monotonic)
        self.framer: Any = self.exchange.framer
        self.alone = self.exchange.alone
        self.writing: Any = self.steps.writer.lock
        self.finished: list[tuple[bytes, int, bool]] = []
        self.error: Exception | None = None
        native = native_calls()
        assert native is not None
        self.lone = native.lone_calls(self.framer, self, self.steps, self.alone, 99.0)

    def swap(self, frame: bytes = REQUEST, timeout: float = 5.0, at: float = 0.0) -> Any:
        try:
            return self.call(frame, timeout, at)
        finally:
            assert self.free == (True, True, None, None)

    def call(self, frame: bytes = REQUEST, timeout: float = 5.0, at: float = 0.0) -> Any:
        command = TABLE.command("get_angles")
        request = EncodedRequest(command, frame, b"", {}, plain=True)
        return self.lone.call(self, request, RetryPolicy(attempts=1), timeout, at)

    def answer_with(self, data: bytes) -> threading.Thread:
        """Let the peer send bytes as soon as a request has come, which stays there."""

        def answer() -> None:
            self.peer.recv(99, socket.MSG_PEEK)
            self.peer.send(data)

        answering = threading.Thread(target=answer)
        answering.start()
        return answering

    @property
    def free(self) -> tuple[bool, bool, object, object]:
        """What a call takes: whether both locks are free, the leader, and what has begun."""
        reading, lent = (
            not lock._is_owned()  # type: ignore[attr-defined]
            for lock in (self.steps.reading, self.lock)
        )
        return reading, lent, self.steps.leading.leader, self.alone.begun

    # What native calls use.

    def resume(self, begun: Begun, events: Any, wait: object, policy: object) -> Any:
        assert self.free[:2] == (False, True), "bytes are sorted in order, and the port may close"
        assert begun is self.alone.begun
        return events

    def wait(self, events: Any) -> Any:
        assert self.free[:2] == (True, True)
        self.alone.begun = self.steps.leading.leader = None
        return events

    def abandon(self, begun: Begun, sent: bool) -> None:
        assert begun is self.alone.begun
        self.sent = sent
        self.alone.begun = self.steps.leading.leader = None

    def finish_write(self, request: bytes, written: int) -> None:
        self.finished.append((request, written, self.writing.locked()))
        if self.error is not None:
            raise self.error

    def close(self) -> None:
        self.ours.close()
        self.peer.close()
        os.close(self.alarm)
