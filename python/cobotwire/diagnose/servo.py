"""Recognise packets of the Feetech servo bus that leak onto the serial line.

``FF FF ID LEN INSTRUCTION|ERROR PARAMETERS CHECKSUM``: LEN counts what follows it, and the checksum
is the inverted low byte of the sum of ID to PARAMETERS. Instructions and error bits are those of
Feetech's "SCS servo communication protocol" and STS memory table (wiki.aifitlab.com,
wiki.juxitech.com). Instructions and status packets differ only in the byte after LEN, and an
error byte may have the value of an instruction.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from cobotwire.codec.interface import Codec, Listening
from cobotwire.diagnose.findings import Finding
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.registers import register_name
from cobotwire.diagnose.residue import Residue, Verdict, Wait

HEADER = b"\xff\xff"
BROADCAST = 0xFE
# Header, id and LEN, which LEN does not count.
OVERHEAD = 4
LONGEST = OVERHEAD + 255
INSTRUCTIONS = {
    0x01: "ping",
    0x02: "read",
    0x03: "write",
    0x04: "reg write",
    0x05: "action",
    0x06: "reset",
    0x82: "sync read",
    0x83: "sync write",
}
# By bit of the error byte; other bits are never set.
ERRORS = {0: "voltage", 1: "sensor", 2: "temperature", 3: "current", 5: "overload"}
ERROR_BITS = sum(1 << bit for bit in ERRORS)


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoPacket(Finding):
    """A packet of the servo bus with a right checksum.

    ``servo`` is 254 for all servos. ``ambiguous``: the packet could also have the other role.
    ``register`` of a status packet is known only if its instruction was received before. ``count``
    is the number of bytes to read from or write to a servo. ``error`` is the error byte of a status
    packet.
    """

    servo: int
    role: Literal["instruction", "status"]
    ambiguous: bool
    instruction: str | None
    error: int | None
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
        """Describe the packet without its bus."""
        servo = "all servos" if self.servo == BROADCAST else f"servo {self.servo}"
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
        names = [name for bit, name in ERRORS.items() if (self.error or 0) >> bit & 1]
        return f", with errors: {', '.join(names)}" if names else ""


def size_of(packet: bytes) -> int | None:
    """Return the size of the packet that ``packet`` starts with, 6..259, or 0 for no packet.

    None means that more bytes are needed.
    """
    if not packet.startswith(HEADER[: len(packet)]):
        return 0
    if len(packet) > 2 and packet[2] > BROADCAST:
        return 0
    if len(packet) < OVERHEAD:
        return None
    size = OVERHEAD + packet[3]
    if packet[3] < 2:
        return 0
    if len(packet) < size:
        return None
    return size if ~sum(packet[2 : size - 1]) & 0xFF == packet[size - 1] else 0


class ServoBus(Recogniser):
    """Recognises packets; remembers instructions, as a status packet does not name its register."""

    starts = rb"\xff(?:\xff|\Z)"

    def __init__(self, codec: Codec, listening: Listening) -> None:
        # Servo id to the register and number of bytes that its next status packet holds.
        self._expected: dict[int, tuple[int | None, int]] = {}

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """Recognise the packet at ``at``; a frame may interrupt it, as its checksum is checked."""
        size = size_of(residue.data[at : at + LONGEST])
        if size is None:
            return None if residue.closed else Wait.WAIT
        return self._packet(residue, at, at + size) if size else None

    def _packet(self, residue: Residue, start: int, end: int) -> ServoPacket:
        packet = residue.data[start:end]
        servo, code, parameters = packet[2], packet[4], packet[5:-1]
        register, count, servos = _targets(code, parameters)
        # A status packet with the error bits of an instruction is rare: assume an instruction.
        is_instruction = fits_instruction(servo, code, parameters)
        is_status = not is_instruction and fits_status(servo, code)
        if is_status:
            register, count = self._expected.get(servo, (None, -1))
            if count != len(parameters):
                register = None
            count, servos = None, ()
        return ServoPacket(
            spans=residue.spans(start, end),
            reason=residue.reason(start),
            servo=servo,
            role="status" if is_status else "instruction",
            ambiguous=is_instruction and fits_status(servo, code),
            instruction=None if is_status else INSTRUCTIONS.get(code, f"0x{code:02X}"),
            error=code if is_status else None,
            register=register,
            register_name=None if register is None else register_name(register),
            count=count,
            servos=servos,
            parameters=parameters,
        )

    def found(self, finding: Finding) -> None:
        """Remember what a packet requests."""
        if isinstance(finding, ServoPacket):
            self._remember(finding)

    def _remember(self, packet: ServoPacket) -> None:
        if packet.role == "status":
            self._expected.pop(packet.servo, None)
        elif packet.instruction == "sync read":
            count = packet.count or 0
            self._expected = {servo: (packet.register, count) for servo in packet.servos}
        elif packet.instruction == "read":
            self._expected = {packet.servo: (packet.register, packet.count or 0)}
        else:
            self._expected = {} if packet.servo == BROADCAST else {packet.servo: (None, 0)}


def fits_instruction(servo: int, code: int, parameters: bytes) -> bool:
    """Return whether the packet has the parameters of an instruction."""
    size = len(parameters)
    if code in (0x82, 0x83):
        return servo == BROADCAST and size >= 3
    fits = {0x01: size == 0, 0x02: size == 2, 0x03: size >= 2, 0x04: size >= 2}
    return fits.get(code, code in INSTRUCTIONS and size == 0)


def fits_status(servo: int, code: int) -> bool:
    """Return whether it can be a status packet: an id of one servo, and known error bits."""
    return servo != BROADCAST and not code & ~ERROR_BITS


def _targets(code: int, parameters: bytes) -> tuple[int | None, int | None, tuple[int, ...]]:
    """Return the register, the number of bytes and the servos that an instruction names."""
    if code not in (0x02, 0x03, 0x04, 0x82, 0x83) or len(parameters) < 2:
        return None, None, ()
    register, count, rest = parameters[0], parameters[1], parameters[2:]
    if code == 0x82:
        return register, count, tuple(rest)
    if code == 0x83:
        return register, count, tuple(rest[:: count + 1])
    return register, count if code == 0x02 else len(parameters) - 1, ()
