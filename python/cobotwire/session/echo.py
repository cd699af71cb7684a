"""Whether the line sends our own bytes back, as a loop, some adapters and a transponder do.

A few requests read as replies too: ``FE FE 03 50 01 FA`` asks whether servo 1 is powered, and an
older arm answers with these very bytes that it is. So the first copy of a question is only a
candidate. If another answer follows, that one counts. If none does by the deadline, the candidate
counts, but only on a line that was never seen to echo: there, a copy that can be no reply has not
come yet.
"""

from __future__ import annotations

from cobotwire.codec.interface import Frame, Noise
from cobotwire.session.request import Request


class EchoWatch:
    """Looks for copies of the request that was sent last; ``proven`` once the line echoes."""

    def __init__(self) -> None:
        self.proven = False
        self._sent: Request | None = None
        self._since = 0
        self._copied = False
        self._noise = b""

    def sent(self, request: Request, offset: int) -> None:
        """A request goes out; what comes from ``offset`` of the stream on may be its copy."""
        self._sent, self._since, self._copied, self._noise = request, offset, False, b""

    def hear_noise(self, noise: Noise) -> None:
        """Most requests are no legal replies, so that their copies come as noise."""
        if self._sent is None or self.proven:
            return
        self._noise += noise.data[max(0, self._since - noise.offset) :]
        self.proven = self._sent.frame in self._noise
        self._noise = self._noise[-len(self._sent.frame) :]

    def is_copy(self, frame: Frame) -> bool:
        """Whether this is the first frame that is a copy. A second one was said by the arm."""
        self._noise = b""
        if self._sent is None or self._copied or frame.offset < self._since:
            return False
        self._copied = frame.data == self._sent.frame
        return self._copied
