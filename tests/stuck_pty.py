"""A pseudo-terminal that nothing reads for a while, so that requests are cut."""

from __future__ import annotations

import os
import select
import tty

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.editions.mycobot280 import TABLE

CODEC = codecs.load(TABLE)
# -2.58 degrees are FE FE, so half of this request and a stop would be a legal motion.
ANGLES = (0.0, 0.0, -2.58, 0.0, 0.0, 0.0)
MOTION = CODEC.encode("send_angles", "request", [ANGLES, 50])
# More bytes than the buffer of a pseudo-terminal holds (64 KiB).
REQUESTS = 4000
STOP = CODEC.encode("stop", "request", [])


def frames(received: bytes) -> list[bytes]:
    """Return the requests that an arm finds in the bytes it received."""
    framer = CODEC.framer("request")
    events = [*framer.feed(received), *framer.flush()]
    return [event.data for event in events if isinstance(event, Frame)]


class StuckPty:
    """A pseudo-terminal that nothing reads until :meth:`drain`."""

    def __init__(self) -> None:
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self.url = os.ttyname(self._slave)

    def drain(self) -> bytes:
        """Return the written bytes, when no more arrive."""
        received = b""
        while select.select([self._master], [], [], 0.2)[0]:
            received += os.read(self._master, 65536)
        return received

    def read(self, size: int) -> bytes:
        """Return up to ``size`` bytes, without waiting."""
        ready, _, _ = select.select([self._master], [], [], 0)
        return os.read(self._master, size) if ready else b""

    def close(self) -> None:
        for descriptor in (self._master, self._slave):
            os.close(descriptor)
