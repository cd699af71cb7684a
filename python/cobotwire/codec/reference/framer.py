"""Cut frames out of a stream, and resynchronise after noise.

A frame stands at position i if the header is there, LEN is legal for CMD, and the check is right.
The first byte that contradicts a candidate rejects it. The scan then continues at i + 1, and never
skips the bytes that the LEN of a false header covers. A candidate that more bytes could complete
waits.
"""

from __future__ import annotations

from typing import NamedTuple, SupportsIndex

from cobotwire.codec.events import Counters, Event, Frame, Noise, NoiseReason, Read
from cobotwire.codec.interface import Data
from cobotwire.codec.reference.validator import Validator
from cobotwire.protocol.rejection import reject_offset


class _State(NamedTuple):
    """What a framer knows: replaced as a whole, so that Ctrl-C leaves the old state or the new one.

    ``waiting`` are the bytes that no event covers yet, from ``offset`` of the stream on.
    """

    waiting: bytes
    offset: int
    counters: Counters
    in_noise: bool


class ReferenceFramer:
    """Cuts frames out of a byte stream; see :class:`cobotwire.codec.interface.Framer`."""

    def __init__(self, validator: Validator, read: Read) -> None:
        self._validator = validator
        self._read = read
        self._state = _State(b"", 0, Counters(0, {}, {}, 0), False)

    @property
    def pending(self) -> int:
        """The number of fed bytes that no event covers yet."""
        return len(self._state.waiting)

    @property
    def fed(self) -> int:
        """The number of bytes fed since the framer was created."""
        return self._state.counters.bytes

    @property
    def counters(self) -> Counters:
        """The counts since the framer was created."""
        counters = self._state.counters
        return counters._replace(frames=dict(counters.frames), noise=dict(counters.noise))

    def start_at(self, offset: int) -> None:
        """Count offsets from ``offset`` on; nothing has been fed yet.

        Raises:
            UsageError: it is negative or beyond 63 bits.
        """
        if not isinstance(offset, SupportsIndex) or not 0 <= offset.__index__() < 2**63:
            raise reject_offset(offset)
        self._state = self._state._replace(offset=offset.__index__())

    def feed(self, data: Data) -> list[Event]:
        """Take bytes; return the events that are certain by now."""
        # Any buffer of bytes is allowed; numbers and lists are not.
        waiting = bytearray(self._state.waiting)
        waiting += data
        return self._cut(bytes(waiting), at_end=False)

    def flush(self) -> list[Event]:
        """Stop waiting for more bytes; return the remaining events."""
        return self._cut(self._state.waiting, at_end=True)

    def _cut(self, data: bytes, at_end: bool) -> list[Event]:
        before, start = self._state, 0
        events: list[Event] = []
        while start < len(data):
            verdict = self._validator.validate(data, start)
            if isinstance(verdict, int):
                frame = data[start : start + verdict]
                id = self._validator.frame.read_id(frame)
                events.append(Frame(before.offset + start, frame, id, self._read))
                start += verdict
            elif verdict == "truncated" and not at_end:
                break
            else:
                end = start + self._rejected_size(data, start, verdict)
                if verdict == "no-header":
                    # No frame starts before the next byte that may begin a header.
                    found = data.find(self._validator.frame.header[:1], end)
                    end = len(data) if found < 0 else found
                self._add_noise(events, before.offset + start, data[start:end], verdict)
                start = min(end, len(data))
        counters, in_noise = _counted(before, len(data) - len(before.waiting), events)
        self._state = _State(data[start:], before.offset + start, counters, in_noise)
        return events

    def _rejected_size(self, data: bytes, start: int, reason: NoiseReason) -> int:
        """Return the number of bytes to skip for a rejected candidate: 1, whatever LEN it has."""
        return 1

    @staticmethod
    def _add_noise(events: list[Event], offset: int, data: bytes, reason: NoiseReason) -> None:
        last = events[-1] if events else None
        if isinstance(last, Noise) and last.reason == reason:
            events[-1] = Noise(last.offset, last.data + data, reason)
        else:
            events.append(Noise(offset, data, reason))


def _counted(before: _State, fed: int, events: list[Event]) -> tuple[Counters, bool]:
    """Return the counters after these events, and whether the last one was noise."""
    counters, in_noise = before.counters, before.in_noise
    frames, noise, resyncs = counters.frames, counters.noise, counters.resyncs
    if events:
        frames, noise = dict(frames), dict(noise)
    for event in events:
        if isinstance(event, Frame):
            frames[event.command] = frames.get(event.command, 0) + 1
            resyncs += in_noise
        else:
            noise[event.reason] = noise.get(event.reason, 0) + len(event.data)
        in_noise = isinstance(event, Noise)
    return Counters(counters.bytes + fed, frames, noise, resyncs), in_noise
