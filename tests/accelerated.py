"""Stream in accelerated time: the transport is in memory and owns the client's clock.

All of cobotwire runs unchanged, but waiting takes no time. The arm numbers its replies, so that
each sample identifies its reply.
"""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Self

from cobotwire.client.streaming import Stream
from cobotwire.editions.mycobot import TABLE, Angles, MyCobot

REPLY_SECONDS = 0.008
# Every n-th reply is lost, 30 ms late, or later than its deadline of 500 ms.
LOST, SLOW, LATE = 5_000, 7_001, 11_003


class Arm:
    """The transport, the arm, and the clock: time passes when the client reads."""

    url = "memory"
    real = False

    def __init__(self) -> None:
        self.now = 1000.0
        self.requests = 0
        self._replies: deque[tuple[float, bytes]] = deque()

    @property
    def clock(self) -> Self:
        """The client's clock: this object."""
        return self

    def __call__(self) -> float:
        """Return the time."""
        return self.now

    def sleep(self, seconds: float) -> None:
        """Let time pass."""
        self.now += seconds

    def write(self, data: bytes) -> None:
        """Schedule a reply with the number of each request; some are late or lost."""
        assert data == b"\xfe\xfe\x02\x20\xfa", "each write is one get_angles"
        number = self.requests
        self.requests += 1
        if number % LOST == LOST - 1:
            return
        wait = 0.03 if number % SLOW == SLOW - 1 else REPLY_SECONDS
        wait = 0.7 if number % LATE == LATE - 1 else wait
        rest, low = divmod(number, 10_000)
        high, middle = divmod(rest, 10_000)
        frame = b"\xfe\xfe\x0e\x20" + struct.pack(">6h", low, middle, high, 0, 0, 0) + b"\xfa"
        self._replies.append((self.now + wait, frame))

    def read(self, timeout: float) -> bytes:
        """Return the next reply when it is due; otherwise let the time pass."""
        if self._replies and self._replies[0][0] <= self.now + timeout:
            due, frame = self._replies.popleft()
            self.now = max(self.now, due)
            return frame
        self.now += timeout
        return b""

    def close(self) -> None:
        """Do nothing."""


def number_in(angles: Angles) -> int:
    """Return the number of the reply with these angles."""
    low, middle, high = (round(angle * 100) for angle in angles[:3])
    return low + 10_000 * (middle + 10_000 * high)


@contextmanager
def accelerated(rate: float) -> Iterator[tuple[Arm, Stream]]:
    """Yield the arm, and a stream of get_angles from it in its time."""
    arm = Arm()
    with (
        MyCobot(arm) as client,
        client.stream(TABLE.request_type("get_angles")(), rate=rate) as stream,
    ):
        yield arm, stream


class Checker:
    """Check that samples are new, in order, and made from the reply to their own request."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm
        self._last = (-1, -1, -1)
        self._replied_at = 0.0

    def check(
        self, number: int, slot: int, angles: Angles, requested: float, replied: float
    ) -> None:
        """Check one more sample."""
        reply = number_in(angles)
        assert reply == self._arm.requests - 1, "the reply to an older request"
        this = (number, slot, reply)
        assert all(new > old for new, old in zip(this, self._last)), (this, self._last)
        assert self._replied_at <= requested < replied <= self._arm.now
        self._last = this
        self._replied_at = replied
