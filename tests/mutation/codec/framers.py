"""Framers that break the framing law in one place each."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from cobotwire.codec.events import Event, Frame, Noise, NoiseReason, Read
from cobotwire.codec.interface import Data, Listening
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.codec.reference.framer import ReferenceFramer
from cobotwire.codec.reference.judge import Heading, Judge
from cobotwire.protocol.table import Table

Verdict = int | NoiseReason


class _Broken(ReferenceFramer):
    """A framer with ``flaw`` in it, or in the legality check that it uses."""

    flaw: ClassVar[str]
    judging: ClassVar[type[Judge]] = Judge

    def __init__(self, right: Judge, read: Read) -> None:
        super().__init__(self.judging(right.frame, right.indexes, right.accept_unknown), read)

    def _claimed(self, data: bytes, start: int) -> int:
        """Return how many bytes a header claims."""
        return _claimed(self._judge, data, start)

    def _forget(self) -> None:
        """Drop the waiting bytes without an event."""
        end = self._state.offset + self.pending
        self._state = self._state._replace(waiting=b"", offset=end)

    def _restart(self) -> None:
        """Count offsets from here on."""
        self._state = self._state._replace(offset=0)


def _claimed(judge: Judge, data: bytes, start: int) -> int:
    return judge.frame.overhead + data[start + judge.frame.length_at]


class _NoFooterJudge(Judge):
    def judge(self, data: bytes, start: int = 0) -> Verdict:
        verdict = super().judge(data, start)
        return _claimed(self, data, start) if verdict == "bad-check" else verdict


class _NoFooter(_Broken):
    flaw = "ignores the footer"
    judging = _NoFooterJudge


class _AnyIdJudge(Judge):
    def refute(self, heading: Heading) -> NoiseReason | None:
        reason = super().refute(heading)
        return None if reason == "unknown-id" else reason


class _AnyId(_Broken):
    flaw = "accepts ids that the edition lacks"
    judging = _AnyIdJudge


class _AnyLengthJudge(Judge):
    def refute(self, heading: Heading) -> NoiseReason | None:
        reason = super().refute(heading)
        return None if reason == "bad-length" else reason


class _AnyLength(_Broken):
    flaw = "accepts any LEN of the edition for any id"
    judging = _AnyLengthJudge


class _HalfHeaderJudge(Judge):
    def judge(self, data: bytes, start: int = 0) -> Verdict:
        head = self.frame.header
        if data[start : start + 1] == head[:1] and len(data) > start + 1:
            data = data[:start] + head + data[start + len(head) :]
        return super().judge(data, start)


class _HalfHeader(_Broken):
    flaw = "checks only the first byte of the header"
    judging = _HalfHeaderJudge


class _SkipsClaimed(_Broken):
    flaw = "skips the whole claimed frame if its footer is wrong"

    def _refuted_size(self, data: bytes, start: int, reason: NoiseReason) -> int:
        return self._claimed(data, start) if reason == "bad-check" else 1


class _SkipsHeader(_Broken):
    flaw = "skips the whole header of a refuted frame"

    def _refuted_size(self, data: bytes, start: int, reason: NoiseReason) -> int:
        return 1 if reason == "no-header" else len(self._judge.frame.header)


class _SkipsTruncated(_Broken):
    flaw = "reports all waiting bytes as noise at a silence"

    def _refuted_size(self, data: bytes, start: int, reason: NoiseReason) -> int:
        return len(data) - start if reason == "truncated" else 1


class _SilenceLoses(_Broken):
    flaw = "forgets the waiting bytes at a silence"

    def flush(self) -> list[Event]:
        self._forget()
        return []


class _SilenceDoesNothing(_Broken):
    flaw = "continues to wait at a silence"

    def flush(self) -> list[Event]:
        return []


class _SilenceRestarts(_Broken):
    flaw = "restarts offsets after a silence"

    def flush(self) -> list[Event]:
        events = super().flush()
        self._restart()
        return events


class _ChunkForgets(_Broken):
    flaw = "forgets the waiting bytes when a new chunk arrives"

    def feed(self, data: Data) -> list[Event]:
        self._forget()
        return super().feed(data)


class _ChunkDecides(_Broken):
    flaw = "treats the end of a chunk as a silence"

    def feed(self, data: Data) -> list[Event]:
        return super().feed(data) + super().flush()


class _ChunkRestarts(_Broken):
    flaw = "restarts offsets in each chunk"

    def feed(self, data: Data) -> list[Event]:
        if not self.pending:
            self._restart()
        return super().feed(data)


class _Late(_Broken):
    flaw = "returns a frame only after the next byte"

    def feed(self, data: Data) -> list[Event]:
        bytes_so_far = self._state.waiting + bytes(data)
        self._state = self._state._replace(waiting=bytes_so_far[:-1])
        events = super().feed(b"")
        self._state = self._state._replace(waiting=self._state.waiting + bytes_so_far[-1:])
        return events


class _Impatient(_Broken):
    flaw = "flushes as soon as more than ten bytes wait"

    def feed(self, data: Data) -> list[Event]:
        events = super().feed(data)
        return events + (super().flush() if self.pending > 10 else [])


class _Rewriting(_Broken):
    """A framer that changes the events it returns."""

    def _changed(self, event: Event) -> list[Event]:
        raise NotImplementedError

    def feed(self, data: Data) -> list[Event]:
        return [changed for event in super().feed(data) for changed in self._changed(event)]

    def flush(self) -> list[Event]:
        return [changed for event in super().flush() for changed in self._changed(event)]


class _NoNoise(_Rewriting):
    flaw = "does not report noise"

    def _changed(self, event: Event) -> list[Event]:
        return [] if isinstance(event, Noise) else [event]


class _OneReason(_Rewriting):
    flaw = "gives the same reason for all noise"

    def _changed(self, event: Event) -> list[Event]:
        return [event._replace(reason="no-header") if isinstance(event, Noise) else event]


class _OtherReason(_Rewriting):
    flaw = "reports bad-check for truncated frames"

    def _changed(self, event: Event) -> list[Event]:
        truncated = isinstance(event, Noise) and event.reason == "truncated"
        return [event._replace(reason="bad-check") if truncated else event]  # type: ignore[union-attr]


class _NoiseShifted(_Rewriting):
    flaw = "counts the offsets of noise from one"

    def _changed(self, event: Event) -> list[Event]:
        return [event._replace(offset=event.offset + 1) if isinstance(event, Noise) else event]


class _FrameShifted(_Rewriting):
    flaw = "reports the offset of LEN as a frame's offset"

    def _changed(self, event: Event) -> list[Event]:
        if isinstance(event, Noise):
            return [event]
        return [
            Frame(event.offset + self._judge.frame.length_at, event.data, event.command, self._read)
        ]


class _NoiseCut(_Rewriting):
    flaw = "drops the last byte of a span of noise"

    def _changed(self, event: Event) -> list[Event]:
        return [event._replace(data=event.data[:-1]) if isinstance(event, Noise) else event]


class _Twice(_Rewriting):
    flaw = "returns each frame twice"

    def _changed(self, event: Event) -> list[Event]:
        return [event] if isinstance(event, Noise) else [event, event]


class _InnerFirstJudge(Judge):
    def judge(self, data: bytes, start: int = 0) -> Verdict:
        verdict = super().judge(data, start)
        if isinstance(verdict, int):
            for inside in range(start + 1, start + verdict):
                if isinstance(super().judge(data[: start + verdict], inside), int):
                    return "bad-check"
        return verdict


class _InnerFirst(_Broken):
    flaw = "prefers a frame inside another one"
    judging = _InnerFirstJudge


class _LowHalfJudge(Judge):
    def judge(self, data: bytes, start: int = 0) -> Verdict:
        verdict = super().judge(data, start)
        return "bad-length" if isinstance(verdict, int) and verdict > 16 else verdict


class _LowHalf(_Broken):
    flaw = "rejects frames longer than sixteen bytes"
    judging = _LowHalfJudge


BROKEN: tuple[type[_Broken], ...] = (
    *(_NoFooter, _AnyId, _AnyLength, _HalfHeader, _SkipsClaimed, _SkipsHeader, _SkipsTruncated),
    *(_SilenceLoses, _SilenceDoesNothing, _SilenceRestarts, _ChunkForgets, _ChunkDecides),
    *(_ChunkRestarts, _Late, _Impatient, _NoNoise, _OneReason, _OtherReason, _NoiseShifted),
    *(_FrameShifted, _NoiseCut, _Twice, _InnerFirst, _LowHalf),
)


class FramingCodec(ReferenceCodec):
    """The reference codec with a framer that is broken for one direction only."""

    def __init__(self, table: Table, kind: type[_Broken], listening: Listening) -> None:
        super().__init__(table)
        self._kind, self._listening = kind, listening

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """Return a framer, broken for the direction of this codec."""
        right = super().framer(listening, accept_unknown=accept_unknown)
        if listening != self._listening:
            return right
        return self._kind(right._judge, right._read)


class DeafCodec(ReferenceCodec):
    """A codec with a framer that listens to another direction than requested."""

    def __init__(self, table: Table, requested: Listening, used: Listening) -> None:
        super().__init__(table)
        self._requested, self._used = requested, used

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """Return a framer, for another direction than the one requested."""
        used = self._used if listening == self._requested else listening
        return super().framer(used, accept_unknown=accept_unknown)


Broken = Callable[[Table], ReferenceCodec]
LISTENING: tuple[Listening, ...] = ("request", "reply", "both")


def broken_framers() -> list[tuple[str, Broken]]:
    """Return each fault in each direction, and framers that listen to another direction."""
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
