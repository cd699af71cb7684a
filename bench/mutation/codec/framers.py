"""Framers that break the law in one place each."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from cobotwire.codec.events import Event, Frame, Noise, NoiseReason
from cobotwire.codec.interface import Data, Listening
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.codec.reference.framer import ReferenceFramer
from cobotwire.table import Table

Verdict = int | NoiseReason


class _Broken(ReferenceFramer):
    """The law, with ``flaw`` in it."""

    flaw: ClassVar[str]

    def _claimed(self, data: bytes, start: int) -> int:
        """The bytes that a header claims."""
        return self._frame.overhead + data[start + self._frame.length_at]


class _NoFooter(_Broken):
    flaw = "does not look at the footer"

    def _judge(self, data: bytes, start: int) -> Verdict:
        verdict = super()._judge(data, start)
        return self._claimed(data, start) if verdict == "bad-check" else verdict


class _AnyId(_Broken):
    flaw = "takes ids that the edition lacks"

    def _refute_id(self, id: int, length: int) -> NoiseReason | None:
        fault = super()._refute_id(id, length)
        return None if fault == "unknown-id" else fault


class _AnyLength(_Broken):
    flaw = "takes any LEN of the edition for any id"

    def _refute_id(self, id: int, length: int) -> NoiseReason | None:
        fault = super()._refute_id(id, length)
        return None if fault == "bad-length" else fault


class _HalfHeader(_Broken):
    flaw = "looks at the first byte of the header alone"

    def _judge(self, data: bytes, start: int) -> Verdict:
        head = self._frame.header
        if data[start : start + 1] == head[:1] and len(data) > start + 1:
            data = data[:start] + head + data[start + len(head) :]
        return super()._judge(data, start)


class _Skipping(_Broken):
    """Moves on by more than a byte behind a header that was refuted."""

    def _step(self, data: bytes, start: int, verdict: NoiseReason) -> int:
        raise NotImplementedError

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
                step = min(self._step(data, start, verdict), len(data) - start)
                part = data[start : start + step]
                self._add_noise(events, self._offset + start, part, verdict)
                start += step
        del self._waiting[:start]
        self._offset += start
        self._count(events)
        return events


class _SkipsClaimed(_Skipping):
    flaw = "skips what a header claimed when the footer is wrong"

    def _step(self, data: bytes, start: int, verdict: NoiseReason) -> int:
        return self._claimed(data, start) if verdict == "bad-check" else 1


class _SkipsHeader(_Skipping):
    flaw = "goes on behind the whole header when it was refuted"

    def _step(self, data: bytes, start: int, verdict: NoiseReason) -> int:
        return 1 if verdict == "no-header" else len(self._frame.header)


class _SkipsTruncated(_Skipping):
    flaw = "takes all that waits for noise when the line is silent"

    def _step(self, data: bytes, start: int, verdict: NoiseReason) -> int:
        return len(data) - start if verdict == "truncated" else 1


class _SilenceLoses(_Broken):
    flaw = "forgets what waits when the line is silent"

    def flush(self) -> list[Event]:
        self._offset += len(self._waiting)
        self._waiting.clear()
        return []


class _SilenceDoesNothing(_Broken):
    flaw = "goes on waiting when the line is silent"

    def flush(self) -> list[Event]:
        return []


class _SilenceRestarts(_Broken):
    flaw = "counts offsets anew behind a silence"

    def flush(self) -> list[Event]:
        events = super().flush()
        self._offset = 0
        return events


class _ChunkForgets(_Broken):
    flaw = "forgets at a new chunk what waits from the last one"

    def feed(self, data: Data) -> list[Event]:
        self._offset += len(self._waiting)
        self._waiting.clear()
        return super().feed(data)


class _ChunkDecides(_Broken):
    flaw = "takes the end of a chunk for a silence"

    def feed(self, data: Data) -> list[Event]:
        return super().feed(data) + super().flush()


class _ChunkRestarts(_Broken):
    flaw = "counts offsets anew in each chunk"

    def feed(self, data: Data) -> list[Event]:
        if not self._waiting:
            self._offset = 0
        return super().feed(data)


class _Late(_Broken):
    flaw = "gives a frame when the byte behind it has come"

    def feed(self, data: Data) -> list[Event]:
        self._waiting += data
        if len(self._waiting) < 2:
            return []
        last = bytes(self._waiting[-1:])
        del self._waiting[-1:]
        events = super().feed(b"")
        self._waiting += last
        return events


class _Impatient(_Broken):
    flaw = "waits with ten bytes at most"

    def feed(self, data: Data) -> list[Event]:
        events = super().feed(data)
        return events + (super().flush() if len(self._waiting) > 10 else [])


class _Rewriting(_Broken):
    """Tells events otherwise than they are."""

    def _told(self, event: Event) -> list[Event]:
        raise NotImplementedError

    def feed(self, data: Data) -> list[Event]:
        return [told for event in super().feed(data) for told in self._told(event)]

    def flush(self) -> list[Event]:
        return [told for event in super().flush() for told in self._told(event)]


class _NoNoise(_Rewriting):
    flaw = "does not tell noise"

    def _told(self, event: Event) -> list[Event]:
        return [] if isinstance(event, Noise) else [event]


class _OneReason(_Rewriting):
    flaw = "gives the same reason for all noise"

    def _told(self, event: Event) -> list[Event]:
        return [event._replace(reason="no-header") if isinstance(event, Noise) else event]


class _OtherReason(_Rewriting):
    flaw = "says bad-check of what was not complete"

    def _told(self, event: Event) -> list[Event]:
        truncated = isinstance(event, Noise) and event.reason == "truncated"
        return [event._replace(reason="bad-check") if truncated else event]  # type: ignore[union-attr]


class _NoiseShifted(_Rewriting):
    flaw = "counts the offsets of noise from one"

    def _told(self, event: Event) -> list[Event]:
        return [event._replace(offset=event.offset + 1) if isinstance(event, Noise) else event]


class _FrameShifted(_Rewriting):
    flaw = "tells the place of LEN as a frame's offset"

    def _told(self, event: Event) -> list[Event]:
        if isinstance(event, Noise):
            return [event]
        return [Frame(event.offset + self._frame.length_at, event.data, event.command, self._read)]


class _NoiseCut(_Rewriting):
    flaw = "forgets the last byte of a span of noise"

    def _told(self, event: Event) -> list[Event]:
        return [event._replace(data=event.data[:-1]) if isinstance(event, Noise) else event]


class _Twice(_Rewriting):
    flaw = "gives each frame twice"

    def _told(self, event: Event) -> list[Event]:
        return [event] if isinstance(event, Noise) else [event, event]


class _InnerFirst(_Broken):
    flaw = "prefers a frame inside another one"

    def _judge(self, data: bytes, start: int) -> Verdict:
        verdict = super()._judge(data, start)
        if isinstance(verdict, int):
            for inside in range(start + 1, start + verdict):
                if isinstance(super()._judge(data[: start + verdict], inside), int):
                    return "bad-check"
        return verdict


class _LowHalf(_Broken):
    flaw = "does not take frames longer than sixteen bytes"

    def _judge(self, data: bytes, start: int) -> Verdict:
        verdict = super()._judge(data, start)
        return "bad-length" if isinstance(verdict, int) and verdict > 16 else verdict


BROKEN: tuple[type[_Broken], ...] = (
    *(_NoFooter, _AnyId, _AnyLength, _HalfHeader, _SkipsClaimed, _SkipsHeader, _SkipsTruncated),
    *(_SilenceLoses, _SilenceDoesNothing, _SilenceRestarts, _ChunkForgets, _ChunkDecides),
    *(_ChunkRestarts, _Late, _Impatient, _NoNoise, _OneReason, _OtherReason, _NoiseShifted),
    *(_FrameShifted, _NoiseCut, _Twice, _InnerFirst, _LowHalf),
)


class FramingCodec(ReferenceCodec):
    """The reference codec with a broken framer for one way to listen; the others are right."""

    def __init__(self, table: Table, kind: type[_Broken], listening: Listening) -> None:
        super().__init__(table)
        self._kind, self._listening = kind, listening

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """A framer; broken where this codec is."""
        right = super().framer(listening, accept_unknown=accept_unknown)
        if listening != self._listening:
            return right
        return self._kind(right._frame, right._forms, accept_unknown)


class DeafCodec(ReferenceCodec):
    """Listens to something else than it is asked to."""

    def __init__(self, table: Table, asked: Listening, heard: Listening) -> None:
        super().__init__(table)
        self._asked, self._heard = asked, heard

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """A framer; for the wrong direction where this codec is broken."""
        heard = self._heard if listening == self._asked else listening
        return super().framer(heard, accept_unknown=accept_unknown)


Broken = Callable[[Table], ReferenceCodec]
LISTENING: tuple[Listening, ...] = ("request", "reply", "both")


def broken_framers() -> list[tuple[str, Broken]]:
    """Each flaw in each way to listen, and each direction taken for another."""
    found: list[tuple[str, Broken]] = []
    for listening in LISTENING:
        for kind in BROKEN:
            name = f"{listening}: {kind.flaw}"
            found.append((name, lambda t, k=kind, way=listening: FramingCodec(t, k, way)))  # type: ignore[misc]
        for other in LISTENING:
            if other != listening:
                name = f"{listening}: listens to {other}"
                found.append((name, lambda t, a=listening, b=other: DeafCodec(t, a, b)))  # type: ignore[misc]
    return found
