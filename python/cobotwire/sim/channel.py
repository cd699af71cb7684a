"""The server's end of one client: a descriptor that never blocks, and the line behind it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cobotwire.sim.line import Line
from cobotwire.sim.peer import LineGone

READ_SIZE = 4096


class End(NamedTuple):
    """How a descriptor is used; the three raise an OSError where the client is gone."""

    descriptor: int
    read: Callable[[int], bytes]
    write: Callable[[bytes], int]
    close: Callable[[], None]


class Channel:
    """Carries bytes between the two, and holds up neither: a client need not read."""

    def __init__(self, end: End, line: Line) -> None:
        self.end = end
        self.line = line
        # Whether room for more of its answers is waited for.
        self.full = False

    def hear(self) -> bool:
        """Take what the client has sent. False: it is gone, or the line is."""
        try:
            data = self.end.read(READ_SIZE)
        except BlockingIOError:
            return True
        except OSError:
            return False
        try:
            self.line.hear(data)
        except LineGone:
            return False
        return bool(data)

    def tell(self) -> bool:
        """Let time pass, and send what the client takes of the answers. False: it is gone."""
        try:
            self.line.pass_time()
        except LineGone:
            return False
        while said := self.line.take():
            try:
                taken = self.end.write(said)
            except BlockingIOError:
                taken = 0
            except OSError:
                return False
            if taken < len(said):
                self.line.put_back(said[taken:])
                break
        return True
