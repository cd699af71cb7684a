"""Cut frames out of a stream, and resynchronise after noise.

A frame stands at position i if the header is there, LEN is legal for CMD, and the check is right.
The first byte that contradicts a candidate refutes it. The scan then continues at i + 1, and never
skips the bytes that a false header claimed. A candidate that more bytes could complete waits.
"""

from __future__ import annotations

from cobotwire.codec.events import Counters, Event, Frame, Noise, NoiseReason, Read
from cobotwire.codec.interface import Data
from cobotwire.codec.reference.judge import Judge


class ReferenceFramer:
    """Cuts frames out of a byte stream; see :class:`cobotwire.codec.interface.Framer`."""

    def __init__(self, judge: Judge, read: Read) -> None:
        self._judge = judge
        self._read = read
        self._waiting = bytearray()
        self._offset = 0
        self._counters = Counters(0, {}, {}, 0)
        self._in_noise = False

    @property
    def pending(self) -> int:
        """The number of fed bytes that no event covers yet."""
        return len(self._waiting)

    @property
    def counters(self) -> Counters:
        """The counts since the framer was created."""
        counters = self._counters
        return counters._replace(frames=dict(counters.frames), noise=dict(counters.noise))

    def feed(self, data: Data) -> list[Event]:
        """Take bytes; return the events that are certain by now."""
        before = len(self._waiting)
        self._waiting += data
        fed = len(self._waiting) - before
        self._counters = self._counters._replace(bytes=self._counters.bytes + fed)
        return self._cut(at_end=False)

    def flush(self) -> list[Event]:
        """Stop waiting for more bytes; return the remaining events."""
        return self._cut(at_end=True)

    def _cut(self, at_end: bool) -> list[Event]:
        events: list[Event] = []
        data, start = bytes(self._waiting), 0
        while start < len(data):
            verdict = self._judge.judge(data, start)
            if isinstance(verdict, int):
                frame = data[start : start + verdict]
                id = frame[self._judge.frame.overhead]
                events.append(Frame(self._offset + start, frame, id, self._read))
                start += verdict
            elif verdict == "truncated" and not at_end:
                break
            else:
                end = start + self._refuted_size(data, start, verdict)
                self._add_noise(events, self._offset + start, data[start:end], verdict)
                start = min(end, len(data))
        del self._waiting[:start]
        self._offset += start
        self._count(events)
        return events

    def _refuted_size(self, data: bytes, start: int, reason: NoiseReason) -> int:
        """Return the number of bytes to skip for a refuted candidate: 1, whatever LEN it has."""
        return 1

    def _count(self, events: list[Event]) -> None:
        _, frames, noise, resyncs = self._counters
        for event in events:
            if isinstance(event, Frame):
                frames[event.command] = frames.get(event.command, 0) + 1
                resyncs += self._in_noise
            else:
                noise[event.reason] = noise.get(event.reason, 0) + len(event.data)
            self._in_noise = isinstance(event, Noise)
        self._counters = self._counters._replace(resyncs=resyncs)

    @staticmethod
    def _add_noise(events: list[Event], offset: int, data: bytes, reason: NoiseReason) -> None:
        last = events[-1] if events else None
        if isinstance(last, Noise) and last.reason == reason:
            events[-1] = Noise(last.offset, last.data + data, reason)
        else:
            events.append(Noise(offset, data, reason))
