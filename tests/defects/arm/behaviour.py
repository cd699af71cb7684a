"""Planted defects: framing, timing, acknowledgements, state and motion go wrong."""

from __future__ import annotations

from collections.abc import Callable

from conformance.independent.arm import COORDS, SIZES, signed
from defects.arm.moving import MovingArm
from defects.arm.replies import framed

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


class Echo(MovingArm):
    """Every request is sent back before its reply."""

    def receive(self, data: bytes) -> bytes:
        """Return the request and the replies."""
        return data + super().receive(data)


class Reboots(MovingArm):
    """set_pin_mode ends in a reboot, whose text goes out on the line; settings are lost."""

    def _reply(self, id: int, data: bytes) -> bytes:
        if id != 0x60:
            return super()._reply(id, data)
        self._reset()
        return b"ets Jun  8 2016 00:22:57\r\n\r\nrst:0xc (SW_CPU_RESET),boot:0x17\r\n"


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


class RepliesToUnknownIds(MovingArm):
    """An unknown id is acknowledged."""

    def _frame(self, data: bytes) -> bytes | None:
        if len(data) >= 5 and data[:2] == b"\xfe\xfe" and data[3] not in SIZES:
            return data[: data[2] + 3] if len(data) >= data[2] + 3 else None
        return super()._frame(data)

    def _reply(self, id: int, data: bytes) -> bytes:
        return super()._reply(id, data) if id in SIZES else framed(id, b"\x01")


class IgnoresFooters(MovingArm):
    """The last byte of a frame may be anything."""

    def _frame(self, data: bytes) -> bytes | None:
        size = SIZES.get(data[3], 99) + 5 if len(data) >= 4 else 99
        if len(data) >= size and data[2] == size - 3:
            return data[: size - 1] + b"\xfa"
        return super()._frame(data)


class IgnoresLengths(MovingArm):
    """LEN may be anything: the id determines where a frame ends."""

    def _frame(self, data: bytes) -> bytes | None:
        if len(data) >= 4 and data[3] in SIZES:
            data = data[:2] + bytes([SIZES[data[3]] + 2]) + data[3:]
        return super()._frame(data)


class NeverGivesUp(MovingArm):
    """Half a request waits for its remainder for ever."""

    wait = None

    def flush(self) -> bytes:
        """Keep half a request."""
        return b""


class OnePerWrite(MovingArm):
    """Only the first request of a write is received."""

    def receive(self, data: bytes) -> bytes:
        """Return the reply to the first request."""
        sent = super().receive(data)
        size = sent[2] + 3 if len(sent) > 4 and sent[:2] == b"\xfe\xfe" else len(sent)
        return sent[:size]


class NewestFirst(MovingArm):
    """Requests in one write are replied to from the last to the first."""

    def receive(self, data: bytes) -> bytes:
        """Return the replies in the wrong order."""
        sent, frames = super().receive(data), []
        while sent[:2] == b"\xfe\xfe" and len(sent) > 4:
            frames.append(sent[: sent[2] + 3])
            sent = sent[sent[2] + 3 :]
        return b"".join(reversed(frames)) + sent


class NeedsWholeWrites(MovingArm):
    """A request in pieces is lost."""

    def receive(self, data: bytes) -> bytes:
        """Forget half a request when more bytes come."""
        self._buffer = b""
        return super().receive(data)


class Acknowledges(MovingArm):
    """set_speed is acknowledged, which the document does not define."""

    def _reply(self, id: int, data: bytes) -> bytes:
        return super()._reply(id, data) + (framed(id, b"\x01") if id == 0x41 else b"")


class AcknowledgesPower(MovingArm):
    """release_all_servos is acknowledged by a frame without data."""

    def _reply(self, id: int, data: bytes) -> bytes:
        return super()._reply(id, data) + (framed(id, b"") if id == 0x13 else b"")


class ForgetsAfterNoise(MovingArm):
    """Bytes before a header reset the speed."""

    def receive(self, data: bytes) -> bytes:
        """Look for bytes before a header."""
        if not self._buffer and data[:1] != b"\xfe":
            self._speed = 50
        return super().receive(data)


class ForgetsAfterWrongLength(MovingArm):
    """A wrong LEN resets the tool's reference."""

    def _lose_state(self, why: str) -> None:
        if why == "LEN":
            self._references[0x81] = bytes(12)


class TakesForbiddenValues(MovingArm):
    """Joint 0 and joint 7 are replied to, as the nearest joint."""

    def _reply(self, id: int, data: bytes) -> bytes:
        if id == 0x4A:
            data = bytes([min(max(data[0], 1), 6)])
        return super()._reply(id, data)


class StoresForbiddenValues(MovingArm):
    """set_end_type stores the type 2, which does not exist, as 1."""

    def _reply(self, id: int, data: bytes) -> bytes:
        return super()._reply(id, bytes([min(data[0], 1)]) if id == 0x89 else data)


class SettingsCoupled(MovingArm):
    """set_reference_frame also resets the end type."""

    def _change(self, id: int, data: bytes) -> None:
        super()._change(id, data)
        if id == 0x85:
            self._flags[0x89] = 0


class AnyInsteadOfAll(MovingArm):
    """is_all_servo_enable reports whether any servo is held."""

    def _answer(self, id: int, data: bytes) -> bytes | None:
        return bytes([any(self._enabled)]) if id == 0x51 else super()._answer(id, data)


class Dies(MovingArm):
    """After 300 requests the arm is silent."""

    def receive(self, data: bytes) -> bytes:
        """Return nothing after 300 requests."""
        sent = super().receive(data)
        return b"" if self._requests > 300 else sent


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


BEHAVIOUR: dict[str, type[MovingArm]] = {
    "late-reply": Late,
    "reply-in-two-halves": Halved,
    "double-reply": Twice,
    "one-reply-behind": OneBehind,
    "echo": Echo,
    "reboots": Reboots,
    "stale-angles": StaleAfterMotion,
    "replies-to-unknown-ids": RepliesToUnknownIds,
    "ignores-footers": IgnoresFooters,
    "ignores-len": IgnoresLengths,
    "never-gives-up-half-a-request": NeverGivesUp,
    "one-request-per-write": OnePerWrite,
    "replies-in-reverse": NewestFirst,
    "needs-whole-writes": NeedsWholeWrites,
    "acknowledges-set-speed": Acknowledges,
    "acknowledges-release": AcknowledgesPower,
    "forgets-after-noise": ForgetsAfterNoise,
    "forgets-after-wrong-len": ForgetsAfterWrongLength,
    "takes-forbidden-values": TakesForbiddenValues,
    "stores-forbidden-values": StoresForbiddenValues,
    "settings-coupled": SettingsCoupled,
    "any-instead-of-all": AnyInsteadOfAll,
    "dies": Dies,
    "never-stops": NeverStops,
    "never-moving": NeverMoving,
    "always-there": AlwaysThere,
    "only-first-joint-counts": OnlyFirstJointCounts,
    "pause-only-reports": PauseOnlyReports,
    "resume-discards": ResumeDiscards,
    "limits-not-kept": LimitsNotKept,
    "drags-neighbour": DragsNeighbour,
}
