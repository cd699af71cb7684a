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


class _Sent:
    """A request that went out: copies of it may come from ``since`` of the stream on."""

    __slots__ = ("copies", "frame", "since")

    def __init__(self, frame: bytes, since: int) -> None:
        self.frame = frame
        self.since = since
        self.copies = 1


class EchoWatch:
    """Looks for copies of the last question and the last order; ``proven`` once the line echoes.

    Both are kept, since an order may go out while a question waits.
    """

    def __init__(self) -> None:
        self.proven = False
        self._question: _Sent | None = None
        self._order: _Sent | None = None
        self._noise = b""

    def sent(self, request: Request, offset: int, *, again: bool = False) -> None:
        """A request goes out; what comes from ``offset`` of the stream on may be its copy."""
        if again and self._question is not None:
            self._question.copies += 1
        elif request.command.answers:
            self._question = _Sent(request.frame, offset)
        else:
            self._order = _Sent(request.frame, offset)
        if not self.proven:
            self._noise = b""

    def hear_noise(self, noise: Noise) -> None:
        """Most requests are no legal replies, so that their copies come as noise."""
        if self.proven:
            return
        watched = [sent for sent in (self._question, self._order) if sent is not None]
        if not watched:
            return
        since = min(sent.since for sent in watched)
        self._noise += noise.data[max(0, since - noise.offset) :]
        self.proven = any(sent.frame in self._noise for sent in watched)
        self._noise = self._noise[-max(len(sent.frame) for sent in watched) :]

    def is_copy(self, frame: Frame) -> bool:
        """Whether this is a copy; one for each time of sending. A further one the arm said."""
        self._noise = b""
        for sent in (self._question, self._order):
            if (
                sent is not None
                and sent.copies
                and frame.offset >= sent.since
                and frame.data == sent.frame
            ):
                sent.copies -= 1
                return True
        return False
