"""A stream in accelerated time: a line in memory that owns the clock by which the driver goes.

Everything of cobotwire runs as it is; only waiting costs nothing. The arm numbers its answers, so
that each sample tells which answer it is made of.
"""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Self

from cobotwire.driver.streaming import Stream
from cobotwire.editions.mycobot import Angles, MyCobot

ANSWER_SECONDS = 0.008
# Every so manieth answer never comes, comes 30 ms late, comes after its deadline of 500 ms.
LOST, SLOW, LATE = 5_000, 7_001, 11_003


class Arm:
    """The line, the arm at its end, and the clock: reading is what takes time."""

    url = "memory"
    real = False

    def __init__(self) -> None:
        self.now = 1000.0
        self.asked = 0
        self._coming: deque[tuple[float, bytes]] = deque()

    @property
    def clock(self) -> Self:
        """By which the driver goes."""
        return self

    def __call__(self) -> float:
        """The time."""
        return self.now

    def sleep(self, seconds: float) -> None:
        """Let time pass."""
        self.now += seconds

    def write(self, data: bytes) -> None:
        """Answer each question with its number, most of them in time."""
        assert data == b"\xfe\xfe\x02\x20\xfa", "one question at a time, of one kind"
        number = self.asked
        self.asked += 1
        if number % LOST == LOST - 1:
            return
        wait = 0.03 if number % SLOW == SLOW - 1 else ANSWER_SECONDS
        wait = 0.7 if number % LATE == LATE - 1 else wait
        rest, low = divmod(number, 10_000)
        high, middle = divmod(rest, 10_000)
        frame = b"\xfe\xfe\x0e\x20" + struct.pack(">6h", low, middle, high, 0, 0, 0) + b"\xfa"
        self._coming.append((self.now + wait, frame))

    def read(self, timeout: float) -> bytes:
        """The next answer, when its time has come; or let the time pass."""
        if self._coming and self._coming[0][0] <= self.now + timeout:
            due, frame = self._coming.popleft()
            self.now = max(self.now, due)
            return frame
        self.now += timeout
        return b""

    def close(self) -> None:
        """There is nothing to close."""


def number_in(angles: Angles) -> int:
    """Which answer this is."""
    low, middle, high = (round(angle * 100) for angle in angles[:3])
    return low + 10_000 * (middle + 10_000 * high)


@contextmanager
def accelerated(rate: float) -> Iterator[tuple[Arm, Stream]]:
    """A stream of get_angles over such a line, by its clock."""
    arm = Arm()
    with MyCobot(arm) as client, client.stream("get_angles", rate=rate) as stream:
        yield arm, stream


class Checker:
    """The laws: no sample twice, none out of order, each the answer to its own question."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm
        self._last = (-1, -1, -1)
        self._answered_at = 0.0

    def check(self, number: int, slot: int, angles: Angles, asked: float, answered: float) -> None:
        """One more sample."""
        answer = number_in(angles)
        assert answer == self._arm.asked - 1, "an answer to an older question"
        this = (number, slot, answer)
        assert all(new > old for new, old in zip(this, self._last)), (this, self._last)
        assert self._answered_at <= asked < answered <= self._arm.now
        self._last = this
        self._answered_at = answered
