"""A robot of two arms on one line, for the edition in ``two_arms.yaml``."""

from __future__ import annotations

from collections.abc import Callable

from defects.arm.arm import SIZES, Arm

HEADER, ALL, LEFT, RIGHT = b"\xfe\xfe", 0, 1, 2
TARGETS = 0x22
# By address: the arms that receive a request; the last one replies.
RIGHT_WAY = {ALL: (RIGHT, LEFT), LEFT: (LEFT,), RIGHT: (RIGHT,)}
DEFECTS = {
    "right-drives-left": {**RIGHT_WAY, RIGHT: (LEFT, RIGHT)},
    "right-is-left": {**RIGHT_WAY, RIGHT: (LEFT,)},
    "left-drives-both": {**RIGHT_WAY, LEFT: (RIGHT, LEFT)},
}


class TwoArms(Arm):
    """The robot; its frames are FE FE, address, LEN, id, data, and the sum of id and data."""

    def __init__(self, clock: Callable[[], float], defect: str = "") -> None:
        super().__init__(clock)
        self._arms = {LEFT: Arm(clock), RIGHT: Arm(clock)}
        self._motions = DEFECTS.get(defect, RIGHT_WAY)

    def frame(self, data: bytes) -> bytes | None:
        """Return the frame at the start; empty if there cannot be one, None if it is incomplete."""
        if data[:2] != HEADER[: len(data)]:
            return b""
        if len(data) < 5:
            return None
        size = SIZES.get(data[4])
        if size is None or data[3] != size + 2 or data[2] not in RIGHT_WAY:
            return b""
        if len(data) < size + 6:
            return None
        return data[: size + 6] if data[size + 5] == sum(data[4 : size + 5]) & 255 else b""

    def carry_out(self, frame: bytes) -> bytes:
        """Let the arms at the address of a request carry it out; return the reply of the last."""
        address, id, data = frame[2], frame[4], frame[5:-1]
        sent, last = b"", address
        for last in (self._motions if id == TARGETS else RIGHT_WAY)[address]:
            sent = self._arms[last].reply(id, data)
        if sent[:2] != HEADER:
            return sent
        body = sent[3:-1]
        return HEADER + bytes([last, len(body) + 1]) + body + bytes([sum(body) & 255])
