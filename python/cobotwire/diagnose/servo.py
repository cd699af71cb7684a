"""Recognise packets of the servo bus that leak onto the serial line.

:mod:`cobotwire.diagnose.servo_bus` reads them. An instruction and a status packet differ only in
the byte after LEN, and the error bits of a status packet may have the value of an instruction.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

from cobotwire.codec.interface import Codec, Listening
from cobotwire.diagnose.findings import Finding
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.residue import Residue, Verdict, Wait

if TYPE_CHECKING:
    from cobotwire.diagnose.servo_bus import ServoBusReader

# Servo id to the register and number of bytes that its next status packet holds.
Expected = dict[int, tuple[int, int]]

# The header FF FF, and an id other than FF. The table knows this too, but is loaded only where this
# matches; see tests/diagnose/test_servo_bus.py.
STARTS = rb"\xff(?:\xff(?:[^\xff]|\Z)|\Z)"
_START = re.compile(STARTS, re.DOTALL)


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoPacket(Finding):
    """A packet of the servo bus with a right checksum.

    ``servo`` is 254 for all servos. ``ambiguous``: the packet could also have the other role.
    ``register`` of a status packet is known only if its instruction was received before. ``count``
    is the number of bytes to read from or write to a servo. ``error`` is the error byte of a status
    packet, and ``errors`` names its bits.
    """

    servo: int
    role: Literal["instruction", "status"]
    ambiguous: bool
    instruction: str | None
    error: int | None
    errors: tuple[str, ...]
    register: int | None
    register_name: str | None
    count: int | None
    servos: tuple[int, ...]
    parameters: bytes
    kind: ClassVar[str] = "servo"
    advice: ClassVar[str] = (
        "the firmware leaks packets of its servo bus; cobotwire skips them, but programs that "
        "expect clean replies may fail: try a newer firmware"
    )
    summary_prefix: ClassVar[str] = "servo bus leak: "
    summary_noun: ClassVar[str] = "packet"

    @property
    def ordinary(self) -> bool:
        """Return True: arms that work leak such packets."""
        return True

    def describe(self) -> str:
        """Describe the packet."""
        doubt = " (or a status with errors)" if self.ambiguous else ""
        return f"servo bus: {self.example()}{doubt}"

    def example(self) -> str:
        """Describe the packet, without the words ``servo bus``."""
        servo = "all servos" if self.servo == servo_bus().every else f"servo {self.servo}"
        if self.role == "status":
            where = "" if self.register is None else f" at {self._register_text()}"
            sent = f" {self.parameters.hex(' ')}{where}" if self.parameters else ""
            return f"status of {servo}{sent}{self._errors_text()}"
        if self.servos:
            servo = f"servos {', '.join(map(str, self.servos))}"
        if self.register is None:
            rest = f" {self.parameters.hex(' ')}" if self.parameters else ""
            return f"{self.instruction} of {servo}{rest}"
        text = f"{self.instruction} {self.count} bytes at {self._register_text()} of {servo}"
        if self.instruction in ("write", "reg write"):
            return f"{text}: {self.parameters[1:].hex(' ')}"
        return text

    def _register_text(self) -> str:
        name = f" ({self.register_name})" if self.register_name else ""
        return f"register 0x{self.register:02X}{name}"

    def _errors_text(self) -> str:
        return f", with errors: {', '.join(self.errors)}" if self.errors else ""


def servo_bus() -> ServoBusReader:
    """Return the reader of packets; it is imported with the reference codec, which it uses."""
    from cobotwire.diagnose import servo_bus

    return servo_bus.servo_bus()


def packet_size(data: bytes, at: int) -> int | None:
    """Return the size of the packet at ``at``; 0 if there is none, None for too few bytes."""
    return servo_bus().size(data, at) if _START.match(data, at) else 0


class ServoBus(Recogniser):
    """Recognises packets; remembers instructions, as a status packet does not name its register.

    Attributes:
        expected: what the next status packets hold.
    """

    starts = STARTS

    def __init__(self, codec: Codec, listening: Listening) -> None:
        self.expected: Expected = {}

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """Recognise the packet at ``at``, even if it contains a frame: its checksum is right."""
        size = packet_size(residue.data, at)
        if size is None:
            return None if residue.closed else Wait.WAIT
        return self._packet(residue, at, at + size) if size else None

    def _packet(self, residue: Residue, start: int, end: int) -> ServoPacket:
        bus, packet = servo_bus(), residue.data[start:end]
        servo, code, parameters = bus.servo(packet), bus.code(packet), bus.parameters(packet)
        instruction, status = bus.instruction(packet), bus.status(servo, code)
        # A status packet with the error bits of an instruction is rare: assume an instruction.
        is_status = instruction is None and status is not None
        content = instruction or bus.unknown(code)
        register, count = content.register, content.size
        if is_status:
            read, expected = self.expected.get(servo, (0, -1))
            register = read if expected == len(parameters) else None
        return ServoPacket(
            spans=residue.spans(start, end),
            reason=residue.reason(start),
            servo=servo,
            role="status" if is_status else "instruction",
            ambiguous=instruction is not None and status is not None,
            instruction=None if is_status else content.name,
            error=code if is_status else None,
            errors=status.errors if is_status and status else (),
            register=register,
            register_name=None if register is None else bus.register_name(register) or None,
            count=count,
            servos=content.servos,
            parameters=parameters,
        )

    def found(self, finding: Finding) -> None:
        """Remember what a packet requests."""
        if isinstance(finding, ServoPacket):
            self._remember(finding)

    def _remember(self, packet: ServoPacket) -> None:
        if packet.role == "status":
            self.expected.pop(packet.servo, None)
            return
        self.expected = {}
        if packet.register is not None and packet.instruction in ("read", "sync read"):
            servos = packet.servos or (packet.servo,)
            self.expected = dict.fromkeys(servos, (packet.register, packet.count or 0))
