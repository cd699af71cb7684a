"""Planted defects: framing, acknowledgements, values and state go wrong."""

from __future__ import annotations

from conformance.independent.arm import SIZES
from defects.arm.moving import MovingArm
from defects.arm.replies import framed


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


BEHAVIOUR: dict[str, type[MovingArm]] = {
    "echo": Echo,
    "reboots": Reboots,
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
}
