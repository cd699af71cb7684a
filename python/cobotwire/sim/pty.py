"""A simulated arm, or whatever answers, on a pseudo-terminal: a port that any program opens."""

from __future__ import annotations

import os
import select
import threading
import tty
from collections import deque
from types import TracebackType
from typing import Self

from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.peer import LineGone, Peer

# Bytes of answers that wait for a client to read; beyond that the oldest answers are lost, as a
# serial line without flow control loses them.
UNREAD_LIMIT = 4096


class PtyPort:
    """Serves a peer on a pty while its ``with`` block runs; ``url`` is the port to open."""

    def __init__(self, peer: Peer) -> None:
        self._peer = peer
        # A byte written to ``stopper`` ends :meth:`serve`.
        self._stop, self.stopper = os.pipe()
        os.set_blocking(self.stopper, False)
        self._master, self._slave = os.openpty()
        # Raw, or the terminal would echo the requests and eat some of their bytes. The slave stays
        # open here, so that a client may come and go.
        tty.setraw(self._slave)
        # A client that does not read must not keep the arm from hearing, nor from ending.
        os.set_blocking(self._master, False)
        self._unread: deque[bytes] = deque()
        self.url = os.ttyname(self._slave)
        self._thread = threading.Thread(target=self.serve, name="cobotwire-sim", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.stop()
        self._thread.join()
        self.close()

    def serve(self) -> None:
        """Answer until :meth:`stop` is called. A peer that takes its line away closes the port."""
        try:
            self._serve()
        except LineGone:
            self._unplug()
            select.select([self._stop], [], [])

    def _serve(self) -> None:
        while True:
            wait = self._peer.wait
            writing = [self._master] if self._unread else []
            ready, writable, _ = select.select([self._master, self._stop], writing, [], wait)
            if self._stop in ready:
                return
            if self._master in ready:
                self._answer(self._peer.receive(os.read(self._master, 4096)))
            elif not writable:
                self._answer(self._peer.flush())
            if self._unread:
                self._write()

    def _answer(self, data: bytes) -> None:
        if data:
            self._unread.append(data)
        while len(self._unread) > 1 and sum(map(len, self._unread)) > UNREAD_LIMIT:
            self._unread.popleft()

    def _write(self) -> None:
        data = self._unread.popleft()
        try:
            rest = data[os.write(self._master, data) :]
        except BlockingIOError:
            rest = data
        if rest:
            self._unread.appendleft(rest)

    def stop(self) -> None:
        """End :meth:`serve`; may be called from another thread or a signal handler."""
        os.write(self.stopper, b"x")

    def close(self) -> None:
        """Give the pty back; whoever has it open hears that the port is gone."""
        self._unplug()
        for descriptor in (self._stop, self.stopper):
            os.close(descriptor)

    def _unplug(self) -> None:
        for descriptor in (self._master, self._slave):
            if descriptor >= 0:
                os.close(descriptor)
        self._master = self._slave = -1


class PtyServer(PtyPort):
    """Serves a simulated arm."""

    def __init__(self, arm: SimulatedArm) -> None:
        super().__init__(arm)
        self.arm = arm
