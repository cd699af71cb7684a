"""Find out whether the line echoes: a loopback, some adapters and a transponder send bytes back.

A few requests are legal replies too: ``FE FE 03 50 01 FA`` queries whether servo 1 is powered, and
older firmware replies "yes" with the same bytes. So the first copy of a request is only a
candidate. If another reply follows, that one counts. If no other reply comes by the deadline, the
candidate counts, unless the line is known to echo: it has sent back a request that cannot be a
reply.
"""

from __future__ import annotations

from cobotwire.codec.interface import Frame, Noise


class _Sent:
    """A request that was sent; ``copies`` of it may begin at ``offset`` of the stream or later."""

    __slots__ = ("copies", "frame", "offset")

    def __init__(self, frame: bytes, offset: int) -> None:
        self.frame = frame
        self.offset = offset
        self.copies = 1

    def repeat(self) -> None:
        """Note that it was sent once more."""
        self.copies += 1

    def take(self, frame: Frame) -> bool:
        """Take a frame if it is one of the copies; return whether it is."""
        if not self.copies or frame.data != self.frame or frame.offset < self.offset:
            return False
        self.copies -= 1
        return True


class EchoDetector:
    """Looks for copies of the last request and of the last one-way request.

    It keeps both, since a one-way request may go out while another request waits for its reply.

    Attributes:
        proven: whether the line was seen to echo.
    """

    def __init__(self) -> None:
        self.proven = False
        self._request: _Sent | None = None
        self._one_way: _Sent | None = None
        self._noise = b""

    def sent(self, frame: bytes, offset: int) -> None:
        """Note a request that goes out; its copy can begin at ``offset`` of the stream."""
        self._request = _Sent(frame, offset)
        self._noise = b""

    def sent_one_way(self, frame: bytes, offset: int) -> None:
        """Note a one-way request that goes out, likewise."""
        self._one_way = _Sent(frame, offset)
        self._noise = b""

    def sent_again(self) -> None:
        """Note that the last request that waits for a reply goes out once more."""
        if self._request is not None:
            self._request.repeat()
        self._noise = b""

    def prove(self) -> None:
        """Note that the line echoes."""
        self.proven = True

    def add_noise(self, noise: Noise) -> None:
        """Look for copies in noise: most requests are not legal replies, so they come as noise."""
        watched = [sent for sent in (self._request, self._one_way) if sent is not None]
        if self.proven or not watched:
            return
        offset = min(sent.offset for sent in watched)
        self._noise += noise.data[max(0, offset - noise.offset) :]
        self.proven = any(sent.frame in self._noise for sent in watched)
        self._noise = self._noise[-max(len(sent.frame) for sent in watched) :]

    def take_copy(self, frame: Frame) -> bool:
        """Return whether a frame is a copy of a request.

        Each request that was sent has one copy; any further copy is a frame of the arm.
        """
        self._noise = b""
        request, one_way = self._request, self._one_way
        if request is not None and request.take(frame):
            return True
        return one_way is not None and one_way.take(frame)
