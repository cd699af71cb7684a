"""The arm in a closed loop: it acknowledges each change, and reports the end of each motion.

It conforms to the edition in ``closed_loop.yaml``, in each variant in ``CORRECT``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from defects.arm.arm import Arm
from defects.arm.numbers import framed
from defects.arm.spoilt import Defect, Right

STOPS = (0x11, 0x13, 0x29, 0x34)
ENDED, ARRIVED, STOPPED = 0x5B, 0, 11
# The shortest time between the replies to two different requests, in seconds.
LATE = 0.04
# How long before the end of a motion a wrong arm reports it, in seconds.
EARLY = 0.1


class ClosedLoopArm(Arm):
    """The arm; ``ends_at`` is the time at which an unreported motion ends, or None."""

    ends_at: float | None = None

    def change(self, id: int, data: bytes) -> None:
        """Carry out a request that is not a query; note or report the end of a motion."""
        moving = self.travel.moves or self.travel.held
        super().change(id, data)
        if id in STOPS and moving:
            self.end(STOPPED)
        elif self.travel.moves:
            self.ends_at = None if self.flags[0x16] else self.travel.ends_at
        elif self.travel.held:
            self.ends_at = None

    def acknowledgement(self, id: int) -> bytes:
        """Acknowledge a change."""
        return framed(id, b"\x01")

    def end(self, status: int) -> None:
        """Report how a motion has ended."""
        self.ends_at = None
        self.later(0.0, framed(ENDED, bytes([status])))

    @property
    def wait(self) -> float | None:
        """The seconds until bytes are due; None: never."""
        before = super().wait
        left = None if self.ends_at is None else max(0.0, self.ends_at - self.clock())
        return min((each for each in (before, left) if each is not None), default=None)

    def flush(self) -> bytes:
        """Return the bytes that are due."""
        if self.ends_at is not None and self.clock() >= self.ends_at:
            # The motion has ended, even if a defect of end() holds back the event.
            self.ends_at = None
            self.end(ARRIVED)
        return super().flush()


def closed_loop_arm(clock: Callable[[], float], switch: str = "") -> Arm:
    """Return a correct variant of the arm or one with a defect; without a name, the plain arm."""
    arm = ClosedLoopArm(clock)
    for method, hook in (CORRECT | DEFECTS)[switch].items():
        setattr(arm, method, partial(hook, arm, getattr(arm, method)))
    arm.reset()
    return arm


def _later(seconds: Callable[[int], float]) -> Defect:
    """Send the acknowledgement of a command later."""

    def acknowledgement(arm: Arm, right: Right, id: int) -> bytes:
        arm.later(seconds(id), right(id))
        return b""

    return {"acknowledgement": acknowledgement}


def _faster(factor: int) -> Defect:
    return {"go": lambda arm, right, ticks, speed: right(ticks, factor * speed)}


def _nul_now_and_then(arm: Arm, right: Right, id: int, data: bytes) -> bytes:
    sent: bytes = right(id, data)
    return b"\0" * (arm.requests % 5 < 3) + sent


def _refreshes_at_first(arm: Arm, right: Right) -> None:
    right()
    arm.flags[0x16] = 1


CORRECT: dict[str, Defect] = {
    "": {},
    "acknowledges-late": _later(lambda id: LATE),
    "acknowledges-very-late": _later(lambda id: 0.45),
    "acknowledges-at-different-times": _later(lambda id: id % 7 * LATE),
    "fast": _faster(3),
    "very-fast": _faster(20),
    "refreshes-at-first": {"reset": _refreshes_at_first},
    "nul-now-and-then": {"reply": _nul_now_and_then},
    "acknowledges-nothing": {"acknowledgement": lambda arm, right, id: b""},
}


def _takes_illegal_speeds(arm: Arm, right: Right, id: int, data: bytes) -> bytes:
    if id != 0x41 or data[0] <= 100:
        return bytes(right(id, data))
    arm.later(LATE, framed(id, b"\x01"))
    return b""


def _twice(arm: Arm, right: Right, id: int) -> bytes:
    arm.later(LATE / 2, right(id))
    return bytes(right(id))


def _refreshes(arm: Arm, right: Right, ticks: list[float], speed: int) -> None:
    mode, arm.flags[0x16] = arm.flags[0x16], 1
    right(ticks, speed)
    arm.flags[0x16] = mode


def _ended(change: Callable[[Arm, Right, int], None]) -> Defect:
    """Return a defect in which ``change`` reports the end of a motion, given its status."""
    return {"end": change}


def _ends_early(arm: Arm, right: Right, id: int, data: bytes) -> None:
    right(id, data)
    if isinstance(arm, ClosedLoopArm) and arm.ends_at is not None:
        arm.ends_at = max(arm.clock(), arm.ends_at - EARLY)


def _ends_twice(arm: Arm, right: Right, status: int) -> None:
    right(status)
    arm.later(2 * LATE, framed(ENDED, bytes([status])))


def _slow_power(arm: Arm, right: Right, id: int, data: bytes) -> None:
    right(id, data)
    if id == 0x10:
        arm.memory["on at"] = arm.clock() + 10 * LATE


def _power(arm: Arm, right: Right, id: int, data: bytes) -> bytes | None:
    late = id == 0x12 and arm.clock() < arm.memory.get("on at", 0.0)
    answer: bytes | None = b"\0" if late else right(id, data)
    return answer


DEFECTS: dict[str, Defect] = {
    "ends-early": {"change": _ends_early},
    "ends-twice": _ended(_ends_twice),
    "ends-never": _ended(lambda arm, right, status: None),
    "ends-never-after-a-stop": _ended(
        lambda arm, right, status: None if status == STOPPED else right(status)
    ),
    "ends-with-success-after-a-stop": _ended(lambda arm, right, status: right(ARRIVED)),
    "ends-with-another-status": _ended(lambda arm, right, status: right(status or 1)),
    "power-on-after-its-acknowledgement": {"change": _slow_power, "answer": _power},
    "fast-and-never-moving": {
        **_faster(3),
        "answer": lambda arm, right, id, data: b"\0" if id == 0x2B else right(id, data),
    },
    "targets-never-wait": {"go": _refreshes},
    "acknowledges-an-illegal-speed": {"reply": _takes_illegal_speeds},
    "acknowledges-twice": {"acknowledgement": _twice},
    "one-change-unacknowledged": {
        "acknowledgement": lambda arm, right, id: b"" if id == 0x41 else right(id)
    },
}
