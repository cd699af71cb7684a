"""A scripted peer on a real pseudo-terminal, or over real TCP."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Self

from transport.ends import End, PtyEnd, TcpEnd

Step = bytes | float | None


class _Peer:
    """After each request, run a script: send bytes, sleep for numbers (seconds), unplug at None."""

    def __init__(self, end: End, *scripts: Sequence[Step]) -> None:
        self.received = b""
        self.url = end.url
        self.end = end
        self._scripts = scripts
        self._stop = False
        self._thread = threading.Thread(target=self._play, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._stop = True
        self._thread.join()
        self.end.unplug()

    def send(self, data: bytes) -> None:
        """Send bytes now, if somebody is connected."""
        with suppress(BrokenPipeError, ConnectionResetError):
            self.end.send(data)

    def _play(self) -> None:
        scripts = list(self._scripts)
        while not self._stop:
            data = self.end.poll(0.02)
            self.received += data
            if not data:
                continue
            for step in scripts.pop(0) if scripts else ():
                if step is None:
                    self.end.unplug()
                    return
                if isinstance(step, bytes):
                    self.send(step)
                else:
                    time.sleep(step)


class ScriptedPeer(_Peer):
    """A scripted peer on a pseudo-terminal."""

    def __init__(self, *scripts: Sequence[Step]) -> None:
        super().__init__(PtyEnd(), *scripts)


class ScriptedTcpPeer(_Peer):
    """A scripted peer over TCP, for one client; each step of bytes is a separate packet."""

    def __init__(self, *scripts: Sequence[Step]) -> None:
        super().__init__(TcpEnd(), *scripts)


PEERS = {"pty": ScriptedPeer, "tcp": ScriptedTcpPeer}
