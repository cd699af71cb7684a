"""The arm with one planted defect, chosen by the name of its switch."""

from __future__ import annotations

from collections.abc import Callable

from defects.arm.behaviour import BEHAVIOUR
from defects.arm.motion import MOTION
from defects.arm.moving import MovingArm
from defects.arm.replies import WrongReply, wrong_replies
from defects.arm.requests import MISREAD, Misread
from defects.arm.timing import TIMING

ARMS: dict[str, type[MovingArm]] = {**TIMING, **BEHAVIOUR, **MOTION}
DEFECTS = (*wrong_replies(), *MISREAD, *ARMS)


class _SpoiltReplies(MovingArm):
    def __init__(self, clock: Callable[[], float], defect: WrongReply) -> None:
        super().__init__(clock)
        self._defect = defect

    def _reply(self, id: int, data: bytes) -> bytes:
        sent = super()._reply(id, data)
        return self._defect.spoil(data, sent) if id == self._defect.id and sent else sent


class _Misreading(MovingArm):
    def __init__(self, clock: Callable[[], float], defect: Misread) -> None:
        super().__init__(clock)
        self._defect = defect

    def _change(self, id: int, data: bytes) -> None:
        read = self._defect.read(data) if id == self._defect.id else data
        if read is not None:
            super()._change(id, read)


def arm_with(clock: Callable[[], float], defect: str = "") -> MovingArm:
    """Return the arm with a defect; without a name, the correct one.

    Raises:
        KeyError: no defect has the name.
    """
    replies = wrong_replies()
    if not defect:
        return MovingArm(clock)
    if defect in replies:
        return _SpoiltReplies(clock, replies[defect])
    if defect in MISREAD:
        return _Misreading(clock, MISREAD[defect])
    return ARMS[defect](clock)
