"""A scripted peer on a real pseudo-terminal or over real TCP."""

from __future__ import annotations

import os
import select
import socket
import threading
import time
import tty
from collections.abc import Sequence
from contextlib import suppress
from types import TracebackType
from typing import Self

Step = bytes | float | None


class _Peer:
    """After each request, run a script: send bytes, sleep for numbers (seconds), unplug at None."""

    url: str

    def __init__(self, *scripts: Sequence[Step]) -> None:
        self.received = b""
        self._scripts = scripts
        self._stop = False
        self._thread = threading.Thread(target=self._play, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._stop = True
        self._thread.join()
        self.unplug()

    def unplug(self) -> None:
        """Disconnect the port from the programs that have it open."""
        raise NotImplementedError

    def send(self, data: bytes) -> None:
        """Send bytes now."""
        raise NotImplementedError

    def _receive(self) -> bytes:
        """Return the received bytes; empty if none arrive within 20 ms."""
        raise NotImplementedError

    def _play(self) -> None:
        scripts = list(self._scripts)
        while not self._stop:
            data = self._receive()
            self.received += data
            if not data:
                continue
            for step in scripts.pop(0) if scripts else ():
                if step is None:
                    self.unplug()
                    return
                if isinstance(step, bytes):
                    self.send(step)
                else:
                    time.sleep(step)


class ScriptedPeer(_Peer):
    """A scripted peer on a pseudo-terminal."""

    def __init__(self, *scripts: Sequence[Step]) -> None:
        super().__init__(*scripts)
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self.url = os.ttyname(self._slave)

    def unplug(self) -> None:
        """Close both ends."""
        for descriptor in (self._master, self._slave):
            if descriptor >= 0:
                os.close(descriptor)
        self._master = self._slave = -1

    def send(self, data: bytes) -> None:
        """Send bytes now."""
        os.write(self._master, data)

    def _receive(self) -> bytes:
        ready, _, _ = select.select([self._master], [], [], 0.02)
        return os.read(self._master, 4096) if ready else b""


class ScriptedTcpPeer(_Peer):
    """A scripted peer over TCP, for one client; each step of bytes is a separate packet."""

    def __init__(self, *scripts: Sequence[Step]) -> None:
        super().__init__(*scripts)
        self._listening = socket.create_server(("127.0.0.1", 0))
        self._listening.settimeout(0.02)
        self._connection: socket.socket | None = None
        self.url = f"socket://127.0.0.1:{self._listening.getsockname()[1]}"

    def unplug(self) -> None:
        """Close the connection, and stop listening."""
        if self._connection is not None:
            self._connection.close()
        self._listening.close()

    def send(self, data: bytes) -> None:
        """Send bytes now."""
        assert self._connection is not None
        with suppress(BrokenPipeError, ConnectionResetError):
            self._connection.sendall(data)

    def _receive(self) -> bytes:
        with suppress(TimeoutError, ConnectionResetError):
            if self._connection is None:
                self._connection, _ = self._listening.accept()
                self._connection.settimeout(0.02)
                self._connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return self._connection.recv(4096)
        return b""


PEERS = {"pty": ScriptedPeer, "tcp": ScriptedTcpPeer}
