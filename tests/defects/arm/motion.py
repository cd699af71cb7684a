"""Planted defects: motions, and what is reported about them, go wrong."""

from __future__ import annotations

from collections.abc import Callable

from conformance.independent.arm import COORDS, signed
from defects.arm.moving import MovingArm


class StaleAfterMotion(MovingArm):
    """The first get_angles after a motion has the angles before it."""

    def __init__(self, clock: Callable[[], float]) -> None:
        super().__init__(clock)
        self._before = b""

    def _reply(self, id: int, data: bytes) -> bytes:
        if id in (0x21, 0x22, 0x31, 0x33):
            self._before = super()._reply(0x20, b"")
        sent = super()._reply(id, data)
        if id == 0x20 and self._before and not self._travel.moves:
            sent, self._before = self._before, b""
        return sent


class NeverStops(MovingArm):
    """stop does nothing."""

    def _change(self, id: int, data: bytes) -> None:
        if id != 0x29:
            super()._change(id, data)


class NeverMoving(MovingArm):
    """is_moving always reports rest."""

    def _answer(self, id: int, data: bytes) -> bytes | None:
        return b"\x00" if id == 0x2B else super()._answer(id, data)


class AlwaysThere(MovingArm):
    """is_in_position always reports that the arm is there."""

    def _is_there(self, data: bytes) -> bool:
        return True


class OnlyFirstJointCounts(MovingArm):
    """is_in_position compares the first number only."""

    def _is_there(self, data: bytes) -> bool:
        scales = COORDS if data[12] else (100,) * 6
        here = self._get_coords() if data[12] else self._get_angles()
        near = 5.0 if data[12] else 0.2
        return abs(signed(data[:2])[0] - signed(here[:2])[0]) / scales[0] <= near


class PauseOnlyReports(MovingArm):
    """pause sets the flag that is_paused reports; the arm moves on."""

    def __init__(self, clock: Callable[[], float]) -> None:
        super().__init__(clock)
        self._flag = 0

    def _answer(self, id: int, data: bytes) -> bytes | None:
        return bytes([self._flag]) if id == 0x27 else super()._answer(id, data)

    def _change(self, id: int, data: bytes) -> None:
        if id in (0x26, 0x28):
            self._flag = int(id == 0x26)
        else:
            super()._change(id, data)


class ResumeDiscards(MovingArm):
    """resume ends the pause, and discards the target."""

    def _change(self, id: int, data: bytes) -> None:
        if id == 0x28:
            self._travel.put(self._travel.place())
        else:
            super()._change(id, data)


class LimitsNotKept(MovingArm):
    """The limits of joints are stored, and motion ignores them."""

    def _go(self, ticks: list[float], speed: int) -> None:  # type: ignore[override]
        limits, self._limits = self._limits, {0x4A: [-1800] * 6, 0x4B: [1800] * 6}
        super()._go(ticks, speed)
        self._limits = limits


class DragsNeighbour(MovingArm):
    """send_angle moves the next joint by two degrees as well."""

    def _send_angle(self, data: bytes) -> None:
        super()._send_angle(data)
        goal = self._travel._goal
        goal[data[0] % 6] += 23


MOTION: dict[str, type[MovingArm]] = {
    "stale-angles": StaleAfterMotion,
    "never-stops": NeverStops,
    "never-moving": NeverMoving,
    "always-there": AlwaysThere,
    "only-first-joint-counts": OnlyFirstJointCounts,
    "pause-only-reports": PauseOnlyReports,
    "resume-discards": ResumeDiscards,
    "limits-not-kept": LimitsNotKept,
    "drags-neighbour": DragsNeighbour,
}
