"""Define the kinds of findings: what noise can be, with its place, bytes, facts and description."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal, NamedTuple

from cobotwire.codec.interface import NoiseReason
from cobotwire.protocol.table import Direction

# This many NULs in a row mean a reboot. About 277 were seen when an arm restarted; other traffic
# has fewer: a frame has at most 16 data bytes, a sync write to six servos 50.
REBOOT_NULS = 64

# The number of characters of a text that are shown.
_SHOWN = 60
_BROADCAST = 0xFE
_SERVO_ERRORS = {0: "voltage", 1: "sensor", 2: "temperature", 3: "current", 5: "overload"}
_DAMAGE = {
    "bad-length": "its LEN is wrong",
    "bad-check": "its end or check is wrong",
    "truncated": "it is cut off",
}


class Span(NamedTuple):
    """Consecutive bytes of the stream; ``offset`` is where they start in it."""

    offset: int
    data: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Noise that belongs together.

    There are several ``spans`` if frames interrupt the noise. ``reason`` is the framer's reason for
    the first byte. ``continued`` marks the next piece of noise that was too long for one finding.
    """

    spans: tuple[Span, ...]
    reason: NoiseReason
    continued: bool = False
    kind: ClassVar[str] = ""
    # How a summary names several findings of the kind: ``PREFIX 3 NOUN, e.g. EXAMPLE``.
    summary_prefix: ClassVar[str] = ""
    summary_noun: ClassVar[str] = ""

    @property
    def offset(self) -> int:
        """Return the offset of the first byte in the stream."""
        return self.spans[0].offset

    @property
    def data(self) -> bytes:
        """Return the bytes, without the frames that interrupt them."""
        return b"".join(span.data for span in self.spans)

    def describe(self) -> str:
        """Describe the finding on one line."""
        return self.kind

    def example(self) -> str:
        """Describe the finding as an example in a summary."""
        return self.describe()

    @property
    def facts(self) -> dict[str, Any]:
        """Return the attributes that are specific to the kind, by name."""
        common = {field.name for field in fields(Finding)}
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name not in common}


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoPacket(Finding):
    """A packet of the servo bus with a right checksum; see :mod:`cobotwire.diagnose.servo`.

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
    summary_prefix: ClassVar[str] = "servo bus leak: "
    summary_noun: ClassVar[str] = "packet"

    def describe(self) -> str:
        """Describe the packet."""
        doubt = " (or a status with errors)" if self.ambiguous else ""
        return f"servo bus: {self.example()}{doubt}"

    def example(self) -> str:
        """Describe the packet without its bus."""
        servo = "all servos" if self.servo == _BROADCAST else f"servo {self.servo}"
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
        names = [name for bit, name in _SERVO_ERRORS.items() if (self.error or 0) >> bit & 1]
        return f", with errors: {', '.join(names)}" if names else ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Text(Finding):
    """A line of readable text, with its line end if it has one."""

    text: str
    kind: ClassVar[str] = "text"
    summary_prefix: ClassVar[str] = "text: "
    summary_noun: ClassVar[str] = "line"

    def describe(self) -> str:
        """Describe the text."""
        return f"text: {self.example()}"

    def example(self) -> str:
        """Return the text in quotes, with escaped control characters, cut if it is long."""
        text = self.text.strip("\r\n")
        return repr(text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "...")


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandError(Finding):
    """The firmware's ``cmd_len error``: it received a damaged request, or two at once."""

    kind: ClassVar[str] = "cmd-len-error"

    def describe(self) -> str:
        """Describe the error."""
        return "the firmware reports cmd_len error: it received a damaged request, or two at once"


@dataclass(frozen=True, slots=True, kw_only=True)
class Panic(Finding):
    """An ESP32 panic dump; what it does not contain is None."""

    core: int | None
    cause: str | None
    pc: int | None
    address: int | None
    backtrace: tuple[int, ...]
    rebooting: bool
    kind: ClassVar[str] = "panic"

    def describe(self) -> str:
        """Describe the panic."""
        text = self.cause_text()
        if self.core is not None:
            text += f" on core {self.core}"
        if self.pc is not None:
            text += f" at 0x{self.pc:08x}"
        if self.backtrace:
            text += f", backtrace of {len(self.backtrace)}"
        return text + (", rebooting" if self.rebooting else "")

    def cause_text(self) -> str:
        """Return the panic with its cause."""
        return f"panic {self.cause or 'of unknown cause'}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Boot(Finding):
    """The boot loader's line with the cause of the boot, such as ``SW_CPU_RESET``."""

    cause: str
    kind: ClassVar[str] = "boot"

    def describe(self) -> str:
        """Describe the boot."""
        return f"the controller boots: {self.cause}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Nuls(Finding):
    """NUL bytes in a row; from ``REBOOT_NULS`` on they mean that the controller restarts."""

    count: int
    reboot: bool
    kind: ClassVar[str] = "nuls"

    def describe(self) -> str:
        """Describe the run."""
        return f"{self.count} NULs" + (": the controller restarts" if self.reboot else "")


@dataclass(frozen=True, slots=True, kw_only=True)
class OppositeFrame(Finding):
    """A frame that is legal in the direction that the framer does not listen to.

    ``sent``: the bytes equal a request that was sent, so it is certainly an echo.
    """

    command: str
    direction: Direction
    sent: bool
    kind: ClassVar[str] = "opposite-frame"
    summary_noun: ClassVar[str] = "frame"

    def describe(self) -> str:
        """Describe the frame."""
        if self.sent:
            return f"echo of our request {self.command}"
        if self.direction == "request":
            return f"a request, {self.command}: an echo, or another host"
        return f"a reply, {self.command}"


@dataclass(frozen=True, slots=True, kw_only=True)
class UnlistedFrame(Finding):
    """A complete frame with an id that the edition lacks in that direction.

    ``command`` is the name of the id in the other direction; None if the edition lacks it there.
    """

    id: int
    command: str | None
    kind: ClassVar[str] = "unlisted-frame"
    summary_noun: ClassVar[str] = "frame"

    def describe(self) -> str:
        """Describe the frame."""
        name = self.command
        known = f"{name}, not listed in this direction" if name else "unknown"
        return f"a complete frame with the id 0x{self.id:02X} ({known})"


@dataclass(frozen=True, slots=True, kw_only=True)
class DamagedFrame(Finding):
    """The header and id of a command without a legal frame; both are None if it is cut before."""

    command: str | None
    id: int | None
    kind: ClassVar[str] = "damaged-frame"
    summary_noun: ClassVar[str] = "damaged frame"

    def describe(self) -> str:
        """Describe the damage."""
        return f"damaged {self.command or 'frame'}: {_DAMAGE.get(self.reason, self.reason)}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Garbage(Finding):
    """Bytes that may have been sent at a lower baud rate; this is a guess.

    ``fitting`` bytes look like it; with probability ``chance`` as many random bytes would.
    """

    fitting: int
    chance: float
    kind: ClassVar[str] = "garbage"
    summary_prefix: ClassVar[str] = "perhaps a wrong baud rate: "
    summary_noun: ClassVar[str] = "stretch"

    def describe(self) -> str:
        """Describe the guess."""
        return (
            f"perhaps a wrong baud rate: {self.fitting} of {len(self.data)} bytes look "
            f"stretched (probability for random bytes: {self.chance:.2g})"
        )

    def example(self) -> str:
        """Return the first bytes."""
        return self.data[: _SHOWN // 4].hex(" ")


@dataclass(frozen=True, slots=True, kw_only=True)
class Unrecognised(Finding):
    """Bytes that no recogniser knows."""

    kind: ClassVar[str] = "unrecognised"


# The kinds that a summary lists one after another, the most important first.
SUMMARIZED: tuple[type[Finding], ...] = (
    ServoPacket,
    OppositeFrame,
    UnlistedFrame,
    DamagedFrame,
    Garbage,
    Text,
)
