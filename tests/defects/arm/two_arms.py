"""A robot of two arms on one line, for the edition in ``two_arms.yaml``."""

from __future__ import annotations

from collections.abc import Callable

from defects.arm.arm import IDLE, SIZES, Arm

HEADER, ALL, LEFT, RIGHT = b"\xfe\xfe", 0, 1, 2
TARGETS = 0x22
# By address: the arms that receive a request; the last one replies.
RIGHT_WAY = {ALL: (RIGHT, LEFT), LEFT: (LEFT,), RIGHT: (RIGHT,)}
DEFECTS = {
    "right-drives-left": {**RIGHT_WAY, RIGHT: (LEFT, RIGHT)},
    "right-is-left": {**RIGHT_WAY, RIGHT: (LEFT,)},
    "left-drives-both": {**RIGHT_WAY, LEFT: (RIGHT, LEFT)},
}


class TwoArms:
    """The robot; its frames are FE FE, address, LEN, id, data, and the sum of id and data."""

    def __init__(self, clock: Callable[[], float], defect: str = "") -> None:
        self._clock, self._buffer, self._at = clock, b"", clock()
        self._arms = {LEFT: Arm(clock), RIGHT: Arm(clock)}
        self._motions = DEFECTS.get(defect, RIGHT_WAY)

    @property
    def wait(self) -> float | None:
        """The seconds until an incomplete request is dropped; None: never."""
        return max(0.0, self._at + IDLE - self._clock()) if self._buffer else None

    def flush(self) -> bytes:
        """Drop an incomplete request."""
        if self._clock() >= self._at + IDLE:
            self._buffer = b""
        return b""

    def receive(self, data: bytes) -> bytes:
        """Take bytes; return the replies."""
        self._at, self._buffer, sent = self._clock(), self._buffer + data, b""
        while self._buffer:
            start = self._buffer.find(HEADER[:1])
            self._buffer = self._buffer[start:] if start >= 0 else b""
            size = self._size(self._buffer)
            if size is None:
                break
            if size:
                address, id, body = self._buffer[2], self._buffer[4], self._buffer[5 : size - 1]
                sent += self._reply(address, id, body)
            self._buffer = self._buffer[size or 1 :]
        return sent

    def _size(self, data: bytes) -> int | None:
        """Return the size of the first frame: 0 without a frame, None if it is incomplete."""
        if data[:2] != HEADER[: len(data)]:
            return 0
        if len(data) < 5:
            return None
        size = SIZES.get(data[4])
        if size is None or data[3] != size + 2 or data[2] not in RIGHT_WAY:
            return 0
        if len(data) < size + 6:
            return None
        return size + 6 if data[size + 5] == sum(data[4 : size + 5]) & 255 else 0

    def _reply(self, address: int, id: int, data: bytes) -> bytes:
        sent, last = b"", address
        for last in (self._motions if id == TARGETS else RIGHT_WAY)[address]:
            sent = self._arms[last].reply(id, data)
        if sent[:2] != HEADER:
            return sent
        body = sent[3:-1]
        return HEADER + bytes([last, len(body) + 1]) + body + bytes([sum(body) & 255])
