"""Devices that break after bytes that are no legal request, or by how requests are cut."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from cobotwire.codec.interface import Codec, Message
from cobotwire.table import Table
from mutation.device.broken import BrokenArm, Fault
from mutation.device.cells import framed
from mutation.device.stimulus import STIMULI, Stimulus
from mutation.mutant import Mutant


class GoesSilent(Fault):
    """After some malformed input nothing is answered any more, or not so many requests."""

    def __init__(self, after: Stimulus, requests: int | None) -> None:
        self._after = after
        self._requests = requests
        self._left: int | None = 0

    def malformed(self, codec: Codec, kind: Stimulus, data: bytes) -> bytes:
        """Break."""
        if kind == self._after:
            self._left = self._requests
        return b""

    def request(self, codec: Codec, asked: Message, data: bytes) -> bytes:
        """Deaf while broken."""
        if self._left == 0:
            return data
        self._left = None if self._left is None else self._left - 1
        return b""


class Answers(Fault):
    """Some malformed input is answered."""

    def __init__(self, to: Stimulus, answer: Callable[[Codec, bytes], bytes]) -> None:
        self._to = to
        self._answer = answer

    def malformed(self, codec: Codec, kind: Stimulus, data: bytes) -> bytes:
        """Say something."""
        return self._answer(codec, data) if kind == self._to else b""


class HearsFewAWrite(Fault):
    """Of the requests of one write only the first ones are answered."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._heard = 0

    def chunk(self, data: bytes) -> None:
        """Another write begins."""
        self._heard = 0

    def request(self, codec: Codec, asked: Message, data: bytes) -> bytes:
        """Deaf after the first ones of a write."""
        self._heard += 1
        return data if self._heard <= self._most else b""


class NeedsWholeWrites(Fault):
    """A request that came in more writes than one is not heard."""

    def __init__(self, writes: int) -> None:
        self._writes = writes
        self._sizes: list[int] = []

    def chunk(self, data: bytes) -> None:
        """Remember how the bytes came."""
        self._sizes.append(len(data))

    def request(self, codec: Codec, asked: Message, data: bytes) -> bytes:
        """Deaf to what needed more writes."""
        needed, size = 0, 0
        for chunk in reversed(self._sizes):
            if size >= len(data):
                break
            needed, size = needed + 1, size + chunk
        return data if needed <= self._writes else b""


def breaks_on_malformed(table: Table) -> Iterator[Mutant]:
    """Every kind of malformed input, and every way to break on it."""
    for stimulus in STIMULI:
        yield _silent(table, stimulus, None, "silent for good")
        yield _silent(table, stimulus, 1, "the next good request is lost")
        yield _silent(table, stimulus, 2, "the next two good requests are lost")
        for text, answer in ANSWERS:
            yield _answering(table, stimulus, text, answer)
    for most in (1, 2):
        text = f"at most {most} of the requests in one write are heard"
        yield _plain(table, text, partial(HearsFewAWrite, most))
    for writes in (1, 2):
        text = f"a request in more than {writes} writes is not heard"
        yield _plain(table, text, partial(NeedsWholeWrites, writes))


def _silent(table: Table, after: Stimulus, requests: int | None, text: str) -> Mutant:
    return _plain(table, f"after {after}, {text}", lambda: GoesSilent(after, requests))


def _answering(
    table: Table, to: Stimulus, text: str, answer: Callable[[Codec, bytes], bytes]
) -> Mutant:
    return _plain(table, f"to {to}, {text}", lambda: Answers(to, answer))


def _plain(table: Table, text: str, fault: Callable[[], Fault]) -> Mutant:
    return Mutant("malformed input", "", "", text, lambda clock: BrokenArm(table, fault(), clock))


def _same(codec: Codec, data: bytes) -> bytes:
    return data


def _frame(codec: Codec, data: bytes) -> bytes:
    """An acknowledgement of whatever id stands where ids stand."""
    at = data.find(codec.table.frame.header) + codec.table.frame.overhead
    return framed(codec.table.frame, data[at] if at < len(data) else data[-1], b"\x01")


# A text is no fault: firmware says ``cmd_len error``, and the edition does not forbid it.
ANSWERS: tuple[tuple[str, Callable[[Codec, bytes], bytes]], ...] = (
    ("it is sent back", _same),
    ("an acknowledgement", _frame),
)
