"""Framers that break the framing law in one place each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

from cobotwire.codec.events import Event, Frame, Noise, NoiseReason, Read
from cobotwire.codec.interface import Data, Listening
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.codec.reference.framer import ReferenceFramer
from cobotwire.codec.reference.validator import Heading, Validator
from cobotwire.protocol.table import Table

Verdict = int | NoiseReason
Change = Callable[["BrokenFramer", Event], list[Event]]
# The correct methods, which a flaw may call.
RightValidate = Callable[[bytes, int], Verdict]
RightFeed = Callable[[Data], list[Event]]
RightFlush = Callable[[], list[Event]]


class Flaw(NamedTuple):
    """What is wrong with a framer. Without a flaw, each hook does what is right."""

    text: str
    validate: Callable[[Validator, RightValidate, bytes, int], Verdict] = (
        lambda _, right, data, at: right(data, at)
    )
    forgives: NoiseReason | None = None
    skip: Callable[[Validator, bytes, int, NoiseReason], int] = lambda *_: 1
    feed: Callable[[BrokenFramer, RightFeed, Data], list[Event]] = lambda _, right, data: right(
        data
    )
    flush: Callable[[BrokenFramer, RightFlush], list[Event]] = lambda _, right: right()
    event: Change = lambda _, event: [event]


class _BrokenValidator(Validator):
    def __init__(self, right: Validator, flaw: Flaw) -> None:
        super().__init__(right.frame, right.indexes, right.accept_unknown)
        self._flaw = flaw

    def validate(self, data: bytes, start: int = 0) -> Verdict:
        return self._flaw.validate(self, super().validate, data, start)

    def reject(self, heading: Heading) -> NoiseReason | None:
        reason = super().reject(heading)
        return None if reason == self._flaw.forgives else reason


class BrokenFramer(ReferenceFramer):
    """A framer with a flaw, which may be in the legality check that it uses."""

    def __init__(self, right: Validator, read: Read, flaw: Flaw) -> None:
        super().__init__(_BrokenValidator(right, flaw), read)
        self._flaw = flaw

    def feed(self, data: Data) -> list[Event]:
        """Take bytes; return the events that the flaw lets through."""
        return self._changed(self._flaw.feed(self, super().feed, data))

    def flush(self) -> list[Event]:
        """Stop waiting, as far as the flaw permits."""
        return self._changed(self._flaw.flush(self, super().flush))

    def _changed(self, events: list[Event]) -> list[Event]:
        return [changed for event in events for changed in self._flaw.event(self, event)]

    def _rejected_size(self, data: bytes, start: int, reason: NoiseReason) -> int:
        return self._flaw.skip(self._validator, data, start, reason)

    def forget(self) -> list[Event]:
        """Drop the waiting bytes without an event."""
        end = self._state.offset + self.pending
        self._state = self._state._replace(waiting=b"", offset=end)
        return []

    def restart(self) -> list[Event]:
        """Count offsets from here on."""
        self._state = self._state._replace(offset=0)
        return []

    def hold_back(self, right: RightFeed, data: Data) -> list[Event]:
        """Take bytes; treat the last one as if it had not come yet."""
        bytes_so_far = self._state.waiting + bytes(data)
        self._state = self._state._replace(waiting=bytes_so_far[:-1])
        events = right(b"")
        self._state = self._state._replace(waiting=self._state.waiting + bytes_so_far[-1:])
        return events

    def at_len(self, event: Frame) -> Frame:
        """Return the frame at the offset of its LEN."""
        offset = event.offset + self._validator.frame.length_at
        return Frame(offset, event.data, event.command, self._read)


def _claimed(validator: Validator, data: bytes, start: int) -> int:
    """Return how many bytes a header claims."""
    return validator.frame.overhead + data[start + validator.frame.length_at]


def _no_footer(validator: Validator, right: RightValidate, data: bytes, start: int) -> Verdict:
    verdict = right(data, start)
    return _claimed(validator, data, start) if verdict == "bad-check" else verdict


def _half_header(validator: Validator, right: RightValidate, data: bytes, start: int) -> Verdict:
    head = validator.frame.header
    if data[start : start + 1] == head[:1] and len(data) > start + 1:
        data = data[:start] + head + data[start + len(head) :]
    return right(data, start)


def _inner_first(validator: Validator, right: RightValidate, data: bytes, start: int) -> Verdict:
    verdict = right(data, start)
    if isinstance(verdict, int):
        for inside in range(start + 1, start + verdict):
            if isinstance(right(data[: start + verdict], inside), int):
                return "bad-check"
    return verdict


def _low_half(validator: Validator, right: RightValidate, data: bytes, start: int) -> Verdict:
    verdict = right(data, start)
    return "bad-length" if isinstance(verdict, int) and verdict > 16 else verdict


def _restarted(framer: BrokenFramer, right: RightFeed, data: Data) -> list[Event]:
    return (framer.restart() if not framer.pending else []) + right(data)


def _impatient(framer: BrokenFramer, right: RightFeed, data: Data) -> list[Event]:
    events = right(data)
    return events + (ReferenceFramer.flush(framer) if framer.pending > 10 else [])


def _of_noise(
    change: Callable[[Noise], list[Event]],
) -> Change:
    """Change only noise."""
    return lambda _, event: change(event) if isinstance(event, Noise) else [event]


def _of_frames(
    change: Callable[[BrokenFramer, Frame], list[Event]],
) -> Change:
    """Change only frames."""
    return lambda framer, event: [event] if isinstance(event, Noise) else change(framer, event)


FLAWS = (
    Flaw("ignores the footer", validate=_no_footer),
    Flaw("accepts ids that the edition lacks", forgives="unknown-id"),
    Flaw("accepts any LEN of the edition for any id", forgives="bad-length"),
    Flaw("checks only the first byte of the header", validate=_half_header),
    Flaw(
        "skips the whole claimed frame if its footer is wrong",
        skip=lambda validator, data, start, reason: (
            _claimed(validator, data, start) if reason == "bad-check" else 1
        ),
    ),
    Flaw(
        "skips the whole header of a rejected frame",
        skip=lambda validator, data, start, reason: (
            1 if reason == "no-header" else len(validator.frame.header)
        ),
    ),
    Flaw(
        "reports all waiting bytes as noise at a silence",
        skip=lambda _, data, start, reason: len(data) - start if reason == "truncated" else 1,
    ),
    Flaw("forgets the waiting bytes at a silence", flush=lambda framer, _: framer.forget()),
    Flaw("continues to wait at a silence", flush=lambda *_: []),
    Flaw(
        "restarts offsets after a silence",
        flush=lambda framer, right: right() + framer.restart(),
    ),
    Flaw(
        "forgets the waiting bytes when a new chunk arrives",
        feed=lambda framer, right, data: framer.forget() + right(data),
    ),
    Flaw(
        "treats the end of a chunk as a silence",
        feed=lambda framer, right, data: right(data) + ReferenceFramer.flush(framer),
    ),
    Flaw("restarts offsets in each chunk", feed=_restarted),
    Flaw("returns a frame only after the next byte", feed=BrokenFramer.hold_back),
    Flaw("flushes as soon as more than ten bytes wait", feed=_impatient),
    Flaw("does not report noise", event=_of_noise(lambda _: [])),
    Flaw(
        "gives the same reason for all noise",
        event=_of_noise(lambda noise: [noise._replace(reason="no-header")]),
    ),
    Flaw(
        "reports bad-check for truncated frames",
        event=_of_noise(
            lambda noise: [
                noise._replace(reason="bad-check") if noise.reason == "truncated" else noise
            ]
        ),
    ),
    Flaw(
        "counts the offsets of noise from one",
        event=_of_noise(lambda noise: [noise._replace(offset=noise.offset + 1)]),
    ),
    Flaw(
        "reports the offset of LEN as a frame's offset",
        event=_of_frames(lambda framer, frame: [framer.at_len(frame)]),
    ),
    Flaw(
        "drops the last byte of a span of noise",
        event=_of_noise(lambda noise: [noise._replace(data=noise.data[:-1])]),
    ),
    Flaw("returns each frame twice", event=_of_frames(lambda _, frame: [frame, frame])),
    Flaw("prefers a frame inside another one", validate=_inner_first),
    Flaw("rejects frames longer than sixteen bytes", validate=_low_half),
)


class FramingCodec(ReferenceCodec):
    """The reference codec with a flawed framer for one direction, or one of another direction."""

    def __init__(
        self, table: Table, listening: Listening, flaw: Flaw | None, used: Listening
    ) -> None:
        super().__init__(table)
        self._listening, self._flaw, self._used = listening, flaw, used

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> ReferenceFramer:
        """Return a framer, broken for the direction of this codec."""
        if listening != self._listening:
            return super().framer(listening, accept_unknown=accept_unknown)
        right = super().framer(self._used, accept_unknown=accept_unknown)
        return BrokenFramer(right._validator, right._read, self._flaw) if self._flaw else right


Broken = Callable[[Table], ReferenceCodec]
LISTENING: tuple[Listening, ...] = ("request", "reply", "both")


def broken_framers() -> Iterator[tuple[str, Broken]]:
    """Yield each fault in each direction, and framers that listen to another direction."""
    for listening in LISTENING:
        for flaw in FLAWS:
            broken = partial(FramingCodec, listening=listening, flaw=flaw, used=listening)
            yield f"{listening}: {flaw.text}", broken
        for other in LISTENING:
            if other != listening:
                broken = partial(FramingCodec, listening=listening, flaw=None, used=other)
                yield f"{listening}: listens to {other}", broken
