"""Framing and resync, as the law says it.

At position i a frame stands if the header is there, LEN is legal for CMD, and the check is right. A
candidate is refuted by the first byte that refutes it; then the scan goes on at i + 1 and never
skips what a false header claimed. A candidate that more bytes could complete waits.
"""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.codec.events import Counters, Event, Frame, Message, Noise, NoiseReason
from cobotwire.codec.interface import Data
from cobotwire.codec.reference.check import check
from cobotwire.codec.reference.decode import read
from cobotwire.codec.reference.legal import Forms
from cobotwire.table import FrameFormat


class ReferenceFramer:
    """Cuts frames out of a byte stream; see :class:`cobotwire.codec.interface.Framer`."""

    def __init__(self, frame: FrameFormat, forms: Sequence[Forms], accept_unknown: bool) -> None:
        self._frame = frame
        self._forms = forms
        self._accept_unknown = accept_unknown
        self._lengths = set().union(*(form.lengths for form in forms))
        if accept_unknown:
            self._lengths |= set(range(frame.length(0), frame.maximum_length + 1))
        self._waiting = bytearray()
        self._offset = 0
        self._counters = Counters(0, {}, {}, 0)
        self._in_noise = False

    @property
    def pending(self) -> int:
        """Bytes fed that no event covers yet."""
        return len(self._waiting)

    @property
    def counters(self) -> Counters:
        """What came so far, in numbers."""
        counters = self._counters
        return counters._replace(frames=dict(counters.frames), noise=dict(counters.noise))

    def feed(self, data: Data) -> list[Event]:
        """Take bytes; give what is certain by now."""
        before = len(self._waiting)
        self._waiting += data
        fed = len(self._waiting) - before
        self._counters = self._counters._replace(bytes=self._counters.bytes + fed)
        return self._cut(at_end=False)

    def flush(self) -> list[Event]:
        """Refute what still waits."""
        return self._cut(at_end=True)

    def _cut(self, at_end: bool) -> list[Event]:
        events: list[Event] = []
        data, start = bytes(self._waiting), 0
        while start < len(data):
            verdict = self._judge(data, start)
            if isinstance(verdict, int):
                frame = data[start : start + verdict]
                id = frame[self._frame.overhead]
                events.append(Frame(self._offset + start, frame, id, self._read))
                start += verdict
            elif verdict == "truncated" and not at_end:
                break
            else:
                self._add_noise(events, self._offset + start, data[start : start + 1], verdict)
                start += 1
        del self._waiting[:start]
        self._offset += start
        self._count(events)
        return events

    def _read(self, data: bytes) -> Message:
        return read(self._forms, data)

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

    def _judge(self, data: bytes, start: int) -> int | NoiseReason:
        """The size of the frame at ``start``, or why there is none (``truncated``: not yet)."""
        frame = self._frame
        rest = data[start : start + frame.overhead + 256]
        if not frame.header.startswith(rest[: len(frame.header)]):
            return "no-header"
        address = rest[len(frame.header) : frame.length_at]
        if address and address[0] not in frame.addresses:
            return "bad-address"
        if len(rest) < frame.overhead:
            return "truncated"
        length = rest[frame.length_at]
        if length not in self._lengths:
            return "bad-length"
        if len(rest) < frame.overhead + 1:
            return "truncated"
        fault = self._refute_id(rest[frame.overhead], length)
        if fault is not None:
            return fault
        size = frame.overhead + length
        if len(rest) < size:
            return "truncated"
        end = size - frame.check_size
        return size if rest[end:size] == check(frame, rest[:end]) else "bad-check"

    def _refute_id(self, id: int, length: int) -> NoiseReason | None:
        if any(form.find(id, length) for form in self._forms):
            return None
        if any(id in form.by_id for form in self._forms):
            return "bad-length"
        return None if self._accept_unknown else "unknown-id"

    @staticmethod
    def _add_noise(events: list[Event], offset: int, data: bytes, reason: NoiseReason) -> None:
        last = events[-1] if events else None
        if isinstance(last, Noise) and last.reason == reason:
            events[-1] = Noise(last.offset, last.data + data, reason)
        else:
            events.append(Noise(offset, data, reason))
