"""Whether the line echoes: a loop, some adapters and a transponder send our own bytes back.

A few requests are legal replies too: ``FE FE 03 50 01 FA`` asks whether servo 1 is powered, and
older firmware says with the same bytes that it is. So the first copy of a request is only a
candidate. If another reply follows, that one counts. If none does by the deadline, the candidate
counts, unless the line was ever seen to echo: to send back a request that cannot be a reply.
"""

from __future__ import annotations

from cobotwire.codec.interface import Frame, Noise
from cobotwire.session.request import EncodedRequest


class _Sent:
    """A request that was sent; ``copies`` of it may begin at ``offset`` of the stream or later."""

    __slots__ = ("copies", "frame", "offset")

    def __init__(self, frame: bytes, offset: int) -> None:
        self.frame = frame
        self.offset = offset
        self.copies = 1


class EchoDetector:
    """Looks for copies of the last request and of the last one-way request.

    It keeps both, since a one-way request may go out while another request waits for its reply.

    Attributes:
        proven: whether the line was seen to echo.
        latest: the frame of the last request, and where its copy can begin, until it matters:
            native calls set this alone.
        one_way: the last one-way request.
    """

    def __init__(self) -> None:
        self.proven = False
        self.latest: tuple[bytes, int] | None = None
        self._request: _Sent | None = None
        self.one_way: _Sent | None = None
        self._noise = b""

    def sent(self, request: EncodedRequest, offset: int) -> None:
        """Note a request that goes out; its copy can begin at ``offset`` of the stream."""
        self.latest = request.frame, offset

    def sent_one_way(self, request: EncodedRequest, offset: int) -> None:
        """Note a one-way request that goes out, likewise."""
        self.one_way = _Sent(request.frame, offset)
        self._restart()

    def sent_again(self) -> None:
        """Note that the last request that waits for a reply goes out once more."""
        self._note_latest()
        if self._request is not None:
            self._request.copies += 1
        self._restart()

    def prove(self) -> None:
        """Note that the line echoes."""
        self.proven = True

    def add_noise(self, noise: Noise) -> None:
        """Look for copies in noise: most requests are not legal replies, so they come as noise."""
        self._note_latest()
        if self.proven:
            return
        watched = [sent for sent in (self._request, self.one_way) if sent is not None]
        if not watched:
            return
        offset = min(sent.offset for sent in watched)
        self._noise += noise.data[max(0, offset - noise.offset) :]
        self.proven = any(sent.frame in self._noise for sent in watched)
        self._noise = self._noise[-max(len(sent.frame) for sent in watched) :]

    def take_copy(self, frame: Frame) -> bool:
        """Return whether a frame is a copy of a request.

        Each sending has one copy; one that comes beyond that is the arm's own frame.
        """
        self._note_latest()
        self._noise = b""
        data = frame.data
        for sent in (self._request, self.one_way):
            if (
                sent is not None
                and data == sent.frame
                and sent.copies
                and frame.offset >= sent.offset
            ):
                sent.copies -= 1
                return True
        return False

    def sent_no_other(self, frame: Frame) -> bool:
        """Return whether a frame, which is no copy of the last request, is no other copy either."""
        self._noise = b""
        return self.one_way is None or frame.data != self.one_way.frame

    def _note_latest(self) -> None:
        if self.latest is not None:
            self._request = _Sent(*self.latest)
            self._restart()
            self.latest = None

    def _restart(self) -> None:
        if not self.proven:
            self._noise = b""
