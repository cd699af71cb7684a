"""What was heard while an answer was waited for, in words."""

from __future__ import annotations

from collections import deque

from cobotwire.codec.interface import Noise
from cobotwire.session.events import Echoed, Late, Unasked

# However much a line brings: so many lines are kept, and so many bytes of each are shown.
LINES = 20
SHOWN = 24


class Heard:
    """A line a frame or span of noise; the last of them, if they are many.

    What a :class:`cobotwire.errors.ReplyTimeout` says of the line is made here and nowhere else.
    """

    __slots__ = ("_lines", "_noise", "_reason", "_size")

    def __init__(self) -> None:
        self._lines: deque[str] | None = None
        self._noise = b""
        self._reason = ""
        self._size = 0

    def add(self, event: Unasked | Late | Echoed | Noise) -> None:
        """Note one event. Adjacent spans of noise are one line, with the first one's reason."""
        if isinstance(event, Noise):
            self._reason = self._reason or event.reason
            self._noise = (self._noise + event.data[:SHOWN])[:SHOWN]
            self._size += len(event.data)
            return
        self._end_noise()
        self._add(f"{_kind(event)} {_shown(event.frame.data, len(event.frame.data))}")

    def lines(self) -> tuple[str, ...]:
        """All of it, oldest first."""
        self._end_noise()
        return tuple(self._lines or ())

    def _end_noise(self) -> None:
        if self._size:
            self._add(f"noise ({self._reason}) {_shown(self._noise, self._size)}")
            self._noise, self._reason, self._size = b"", "", 0

    def _add(self, line: str) -> None:
        # Most answers come with nothing around them: nothing is made for these.
        if self._lines is None:
            self._lines = deque(maxlen=LINES)
        self._lines.append(line)


def _kind(event: Unasked | Late | Echoed) -> str:
    if isinstance(event, Late):
        return f"late reply to {event.command.name}"
    return "the question's own bytes" if isinstance(event, Echoed) else "frame"


def _shown(data: bytes, size: int) -> str:
    rest = f" ... {size} bytes" if size > SHOWN else ""
    return data[:SHOWN].hex(" ").upper() + rest
