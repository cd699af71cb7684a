"""Let one of the maker's classes, unmodified, drive our simulated robot.

Time is stepped: the class waits and sleeps by the clock of the robot, so a request without a reply
costs no real time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

# How long a read of the port waits for a byte, in seconds.
READ_TIMEOUT = 0.05


class SteppedTime:
    """Stand in for the module ``time`` in the modules of the maker's library."""

    def __init__(self) -> None:
        self.now = 1000.0

    def time(self) -> float:
        return self.now

    monotonic = perf_counter = time

    def sleep(self, seconds: float) -> None:
        self.now += seconds

    def __getattr__(self, name: str) -> Any:
        return getattr(time, name)


class ArmPort:
    """The part of ``serial.Serial`` that the maker's classes use, on a robot in this process.

    Attributes:
        written: what the class has written.
    """

    def __init__(self, arm: Any, clock: SteppedTime) -> None:
        self._peer, self._clock, self._waiting = arm.connect(), clock, b""
        self.written = b""
        self.timeout = READ_TIMEOUT

    def isOpen(self) -> bool:
        return True

    is_open = True

    def reset_input_buffer(self) -> None:
        self._waiting = b""

    def write(self, data: Any) -> int:
        self.written += bytes(data)
        self._waiting += self._peer.receive(bytes(data))
        return len(data)

    def flush(self) -> None:
        """Do nothing: the robot has received everything."""

    def inWaiting(self) -> int:
        self._waiting += self._peer.flush()
        return len(self._waiting)

    in_waiting = property(inWaiting)

    def read(self, size: int = 1) -> bytes:
        if not self._waiting:
            self._clock.sleep(READ_TIMEOUT)
            self._waiting += self._peer.flush()
        data, self._waiting = self._waiting[:size], self._waiting[size:]
        return data

    def close(self) -> None:
        """Do nothing: there is nothing to release."""


class Fixed:
    """Stands in for an arm: it replies with the same bytes to everything."""

    wait = None

    def __init__(self, reply: bytes) -> None:
        self._reply = reply

    def connect(self) -> Fixed:
        return self

    def receive(self, data: bytes) -> bytes:
        return self._reply

    def flush(self) -> bytes:
        return b""


@contextmanager
def stepped() -> Iterator[SteppedTime]:
    """Step the time of the maker's library, and of our layer."""
    clock, modules = SteppedTime(), _timed(len(sys.modules))
    for module in modules:
        module.time = clock
    try:
        yield clock
    finally:
        for module in modules:
            module.time = time


@lru_cache(maxsize=1)
def _timed(loaded: int) -> list[Any]:
    """Return the modules of the library and of our layer that use the time."""
    names = ("pymycobot", "cobotwire.pymycobot")
    found = [module for name, module in sys.modules.items() if name.startswith(names)]
    return [each for each in found if isinstance(getattr(each, "time", None), type(time))]
