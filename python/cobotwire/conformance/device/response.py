"""The response to a request: replies, frames that were not requested, noise."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cobotwire.codec.interface import DecodedMessage, Frame
from cobotwire.conformance.hex_text import shown
from cobotwire.diagnose import DamagedFrame, Finding
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.messages import Reply
from cobotwire.session.matching import repeats_arguments
from cobotwire.session.request import EncodedRequest


class ReceivedReply(NamedTuple):
    """A frame with the request's id, ``seconds`` after the request; or the text that replies to it.

    If the edition does not allow it, ``error`` says why, and there is no ``message``. ``decoded``
    holds the values of a frame as the codec returns them; a text has none.
    """

    seconds: float
    data: bytes
    error: ProtocolError | None = None
    message: Reply[Any] | None = None
    decoded: DecodedMessage | None = None


@dataclass(slots=True)
class Response:
    """Everything that was received between a request and the next one.

    An acknowledgement that comes after the next request is still added to ``replies``. ``sent_at``
    is when the request was sent, in seconds of the run. ``late`` is whether its deadline passed
    without a reply.
    """

    request: EncodedRequest
    sent_at: float
    # The last request of another command that had a reply.
    earlier: EncodedRequest | None = None
    replies: list[ReceivedReply] = field(default_factory=list)
    others: list[Frame] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    late: bool = False

    @property
    def noise(self) -> list[Finding]:
        """Noise that also occurs with healthy arms."""
        return [finding for finding in self.findings if finding.ordinary]

    @property
    def unexpected(self) -> list[str]:
        """What was not requested and is not explained as noise, in words."""
        found = [f"the frame {shown(frame.data)}{self._again(frame)}" for frame in self.others]
        return found + [
            f"{self._kind(finding)} {shown(finding.data)}"
            for finding in self.findings
            if not finding.ordinary
        ]

    def _again(self, frame: Frame) -> str:
        """Return which earlier request a frame may be a second reply to."""
        if self.earlier is None or frame.command != self.earlier.command.id:
            return ""
        return f" (a second or late reply to {self.earlier.command.name})"

    def _kind(self, finding: Finding) -> str:
        is_copy = finding.data == self.request.frame
        return "a copy of the request (an echo)" if is_copy else finding.kind

    @property
    def damaged(self) -> list[DamagedFrame]:
        """Findings that begin like a frame with the request's id, but are not a legal frame."""
        return [
            finding
            for finding in self.findings
            if isinstance(finding, DamagedFrame) and finding.id in (None, self.request.command.id)
        ]

    @property
    def valid(self) -> ReceivedReply | None:
        """The first legal reply with the right echo."""
        for reply in self.replies:
            if self.accepts(reply):
                return reply
        return None

    @property
    def only_valid(self) -> bool:
        """Whether one valid reply came, and nothing unexpected."""
        return len(self.replies) == 1 and self.valid is not None and not self.unexpected

    def accepts(self, reply: ReceivedReply) -> bool:
        """Return whether a reply is legal and repeats the arguments."""
        if reply.error is not None:
            return False
        return reply.decoded is None or repeats_arguments(reply.decoded, self.request)

    @property
    def summary(self) -> str:
        """What was received, in words."""
        parts = [shown(reply.data) for reply in self.replies] + self.unexpected
        parts += [f"noise {shown(finding.data)}" for finding in self.noise]
        return "; ".join(parts) or "nothing"
