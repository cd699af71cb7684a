"""A scripted peer on a real pseudo-terminal: it says what the test tells it to."""

from __future__ import annotations

import os
import select
import threading
import time
import tty
from collections.abc import Sequence
from types import TracebackType
from typing import Self

Step = bytes | float | None


class ScriptedPeer:
    """Waits for a request, then plays its script: bytes are sent, numbers slept, None unplugs."""

    def __init__(self, *scripts: Sequence[Step]) -> None:
        self.heard = b""
        self._scripts = scripts
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self.url = os.ttyname(self._slave)
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
        """Close both ends: whoever has the port open hears that it is gone."""
        for descriptor in (self._master, self._slave):
            if descriptor >= 0:
                os.close(descriptor)
        self._master = self._slave = -1

    def say(self, data: bytes) -> None:
        """Send bytes now."""
        os.write(self._master, data)

    def _play(self) -> None:
        scripts = list(self._scripts)
        while not self._stop:
            ready, _, _ = select.select([self._master], [], [], 0.02)
            if not ready:
                continue
            self.heard += os.read(self._master, 4096)
            for step in scripts.pop(0) if scripts else ():
                if step is None:
                    self.unplug()
                    return
                if isinstance(step, bytes):
                    self.say(step)
                else:
                    time.sleep(step)
