"""What came after a request: replies, frames that nobody asked for, noise."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cobotwire.codec.interface import Frame, Message
from cobotwire.diagnose import CommandError, DamagedFrame, Finding, Nuls, ServoPacket, Text
from cobotwire.errors import ProtocolError
from cobotwire.session.request import Request, fits

# What a sound arm's line carries beside frames: packets of the servo bus, the firmware's text.
NOISE = (ServoPacket, Text, CommandError)


@dataclass(frozen=True, slots=True)
class Reply:
    """A frame with the request's id, ``seconds`` after the request; or the text that answers it.

    ``message`` is None where the edition rules it out; ``error`` then says why.
    """

    seconds: float
    data: bytes
    message: Message | None
    error: ProtocolError | None
    fields: dict[str, Any]


@dataclass(slots=True)
class Hearing:
    """Everything that was heard between a request and the next one."""

    request: Request
    replies: list[Reply] = field(default_factory=list)
    others: list[Frame] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    @property
    def noise(self) -> list[Finding]:
        """What a sound arm's line carries beside frames."""
        return [finding for finding in self.findings if _is_noise(finding)]

    @property
    def strays(self) -> list[str]:
        """What nobody asked for and no noise explains, in words."""
        found = [f"the frame {shown(frame.data)}" for frame in self.others]
        return found + [
            f"{finding.kind} {shown(finding.data)}"
            for finding in self.findings
            if not _is_noise(finding)
        ]

    @property
    def damaged(self) -> list[DamagedFrame]:
        """What begins as a frame of the request's id and is none."""
        return [
            finding
            for finding in self.findings
            if isinstance(finding, DamagedFrame) and finding.id in (None, self.request.command.id)
        ]

    @property
    def refused(self) -> bool:
        """Whether the firmware's text says that it did not understand."""
        return any(isinstance(finding, CommandError) for finding in self.findings)

    @property
    def good(self) -> Reply | None:
        """The first legal reply that repeats what it must."""
        return next((reply for reply in self.replies if self.fitting(reply)), None)

    def fitting(self, reply: Reply) -> bool:
        """Whether a reply is legal and repeats the arguments."""
        if reply.error is not None:
            return False
        return reply.message is None or fits(reply.message, self.request)

    @property
    def came(self) -> str:
        """In words, for a reason: what came."""
        parts = [shown(reply.data) for reply in self.replies] + self.strays
        parts += [f"noise {shown(finding.data)}" for finding in self.noise]
        return "; ".join(parts) or "nothing"


def shown(data: bytes, most: int = 40) -> str:
    """Bytes as people write them, cut where they get long."""
    text = data[:most].hex(" ").upper()
    return text if len(data) <= most else f"{text} ... ({len(data)} bytes)"


def _is_noise(finding: Finding) -> bool:
    return isinstance(finding, NOISE) or (isinstance(finding, Nuls) and not finding.reboot)
