"""What noise can turn out to be: a small record a kind, with its place, bytes and facts."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal, NamedTuple

from cobotwire.codec.interface import NoiseReason
from cobotwire.table import Direction

# So many NULs in a row are a reboot. Where an arm restarted, about 277 were seen; what a line
# carries otherwise stays below: a frame has at most 16 data bytes, a sync write to six servos 50.
REBOOT_NULS = 64


class Span(NamedTuple):
    """Bytes that stand together in the stream; ``offset`` is where they start in it."""

    offset: int
    data: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """Noise that belongs together.

    ``spans`` are more than one where frames stand in between. ``reason`` is the framer's for the
    first byte. ``continued`` marks a further piece of what was too long for one finding.
    """

    spans: tuple[Span, ...]
    reason: NoiseReason
    continued: bool = False
    kind: ClassVar[str] = ""

    @property
    def offset(self) -> int:
        """Where its first byte stands in the stream."""
        return self.spans[0].offset

    @property
    def data(self) -> bytes:
        """Its bytes, without the frames that stand in between."""
        return b"".join(span.data for span in self.spans)

    @property
    def facts(self) -> dict[str, Any]:
        """What its kind adds, by name."""
        common = {field.name for field in fields(Finding)}
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name not in common}


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoPacket(Finding):
    """A packet of the servo bus whose checksum is right; see :mod:`cobotwire.diagnose.servo`.

    ``servo`` is 254 for all of them. ``ambiguous``: the packet reads as well as the other role.
    ``register`` is a status reply's only if the request for it was heard. ``count`` is the number
    of bytes that are asked for or written to a servo. ``error`` is a status reply's error byte.
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Text(Finding):
    """A readable line, its line end included; without one where the line breaks off."""

    text: str
    kind: ClassVar[str] = "text"


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandError(Finding):
    """The firmware's ``cmd_len error``: it heard a request that is damaged, or two at once."""

    kind: ClassVar[str] = "cmd-len-error"


@dataclass(frozen=True, slots=True, kw_only=True)
class Panic(Finding):
    """An ESP32 panic dump; what it does not tell is None. Addresses are the program's."""

    core: int | None
    cause: str | None
    pc: int | None
    address: int | None
    backtrace: tuple[int, ...]
    rebooting: bool
    kind: ClassVar[str] = "panic"


@dataclass(frozen=True, slots=True, kw_only=True)
class Boot(Finding):
    """The boot loader's line that tells why it runs, such as ``SW_CPU_RESET``."""

    cause: str
    kind: ClassVar[str] = "boot"


@dataclass(frozen=True, slots=True, kw_only=True)
class Nuls(Finding):
    """NUL bytes in a row; many of them (``REBOOT_NULS``) are a controller that restarts."""

    count: int
    reboot: bool
    kind: ClassVar[str] = "nuls"


@dataclass(frozen=True, slots=True, kw_only=True)
class OtherWay(Finding):
    """A frame that is legal in the direction that is not listened to.

    ``sent``: these are the bytes that were told to be sent, so it is an echo for sure.
    """

    command: str
    direction: Direction
    sent: bool
    kind: ClassVar[str] = "other-way"


@dataclass(frozen=True, slots=True, kw_only=True)
class UnlistedFrame(Finding):
    """A whole frame with an id that the edition lacks in that direction.

    ``command`` is what the edition calls the id in the other direction, None if it has none there.
    """

    id: int
    command: str | None
    kind: ClassVar[str] = "unlisted-frame"


@dataclass(frozen=True, slots=True, kw_only=True)
class DamagedFrame(Finding):
    """The header and id of a command, but no frame; both are None if it breaks off before."""

    command: str | None
    id: int | None
    kind: ClassVar[str] = "damaged-frame"


@dataclass(frozen=True, slots=True, kw_only=True)
class Garbage(Finding):
    """Perhaps bytes that were sent at a lower baud rate. A guess, with how good it is.

    ``fitting`` bytes look so; ``chance`` (0..1) is how often as many random bytes would.
    """

    fitting: int
    chance: float
    kind: ClassVar[str] = "garbage"


@dataclass(frozen=True, slots=True, kw_only=True)
class Unrecognised(Finding):
    """Bytes of which nothing can be said."""

    kind: ClassVar[str] = "unrecognised"
