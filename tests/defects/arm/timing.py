"""Planted defects: replies come late, twice, or after the next request."""

from __future__ import annotations

from collections.abc import Callable

from defects.arm.moving import MovingArm

LATE, A_LITTLE = 0.7, 0.01


class TimedArm(MovingArm):
    """The correct arm; ``_later`` sends bytes after some seconds."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._due: list[tuple[float, bytes]] = []
        super().__init__(clock)

    @property
    def wait(self) -> float | None:
        """Seconds until something is due."""
        waits = [] if (wait := super().wait) is None else [wait]
        return min((*waits, *(max(0.0, at - self._clock()) for at, _ in self._due)), default=None)

    def flush(self) -> bytes:
        """Return what is due by now."""
        sent = super().flush()
        now = self._clock()
        sent += b"".join(data for at, data in self._due if at <= now)
        self._due = [(at, data) for at, data in self._due if at > now]
        return sent

    def _later(self, seconds: float, data: bytes) -> None:
        self._due.append((self._clock() + seconds, data))


class Late(TimedArm):
    """get_coords is replied to after its deadline."""

    def _reply(self, id: int, data: bytes) -> bytes:
        sent = super()._reply(id, data)
        if id != 0x23:
            return sent
        self._later(LATE, sent)
        return b""


class Halved(TimedArm):
    """The second half of the reply to get_encoders comes much later."""

    def _reply(self, id: int, data: bytes) -> bytes:
        sent = super()._reply(id, data)
        if id != 0x3D:
            return sent
        self._later(LATE, sent[8:])
        return sent[:8]


class Twice(TimedArm):
    """get_gripper_value is replied to twice, the second time a little later."""

    def _reply(self, id: int, data: bytes) -> bytes:
        sent = super()._reply(id, data)
        if id == 0x65:
            self._later(A_LITTLE, sent)
        return sent


class OneBehind(MovingArm):
    """Each reply is sent only when the next request comes."""

    def __init__(self, clock: Callable[[], float]) -> None:
        super().__init__(clock)
        self._held = b""

    def receive(self, data: bytes) -> bytes:
        """Return the replies to the requests before."""
        sent = super().receive(data)
        if not sent:
            return b""
        sent, self._held = self._held, sent
        return sent


TIMING: dict[str, type[MovingArm]] = {
    "late-reply": Late,
    "reply-in-two-halves": Halved,
    "double-reply": Twice,
    "one-reply-behind": OneBehind,
}
