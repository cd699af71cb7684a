"""Devices that break on bytes that are not a legal request, or on requests cut into writes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.table import Table
from mutation.device.broken import BrokenArm, Fault
from mutation.device.cells import framed
from mutation.device.stimulus import STIMULI, Stimulus
from mutation.mutant import Mutant


class GoesSilent(Fault):
    """After some malformed input, the next requests (or all) get no reply."""

    def __init__(self, after: Stimulus, requests: int | None) -> None:
        self._after = after
        self._requests = requests
        self._left: int | None = 0

    def malformed(self, codec: Codec, kind: Stimulus, data: bytes) -> bytes:
        """Break, and send nothing."""
        if kind == self._after:
            self._left = self._requests
        return b""

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return nothing while the device is broken."""
        if self._left == 0:
            return data
        self._left = None if self._left is None else self._left - 1
        return b""


class RepliesToMalformed(Fault):
    """Some malformed input gets a reply."""

    def __init__(self, to: Stimulus, reply: Callable[[Codec, bytes], bytes]) -> None:
        self._to = to
        self._reply = reply

    def malformed(self, codec: Codec, kind: Stimulus, data: bytes) -> bytes:
        """Return the reply."""
        return self._reply(codec, data) if kind == self._to else b""


class ReceivesFewPerWrite(Fault):
    """Only the first requests of a write are received."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._received = 0

    def chunk(self, data: bytes) -> None:
        """Restart the count."""
        self._received = 0

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return nothing after the first requests of a write."""
        self._received += 1
        return data if self._received <= self._most else b""


class NeedsWholeWrites(Fault):
    """A request that arrives in more than ``writes`` writes is not received."""

    def __init__(self, writes: int) -> None:
        self._writes = writes
        self._sizes: list[int] = []

    def chunk(self, data: bytes) -> None:
        """Remember the size of a write."""
        self._sizes.append(len(data))

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return nothing for a request that arrived in more writes."""
        needed, size = 0, 0
        for chunk in reversed(self._sizes):
            if size >= len(data):
                break
            needed, size = needed + 1, size + chunk
        return data if needed <= self._writes else b""


def breaks_on_malformed(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each kind of malformed input and each way to break on it."""
    for stimulus in STIMULI:
        yield _silent(table, stimulus, None, "the device sends no more replies")
        yield _silent(table, stimulus, 1, "the next good request is lost")
        yield _silent(table, stimulus, 2, "the next two good requests are lost")
        for text, reply in ANSWERS:
            yield _answering(table, stimulus, text, reply)
    for most in (1, 2):
        text = f"at most {most} of the requests in one write are received"
        yield _plain(table, text, partial(ReceivesFewPerWrite, most))
    for writes in (1, 2):
        text = f"a request in more than {writes} writes is not received"
        yield _plain(table, text, partial(NeedsWholeWrites, writes))


def _silent(table: Table, after: Stimulus, requests: int | None, text: str) -> Mutant:
    return _plain(table, f"after {after}, {text}", lambda: GoesSilent(after, requests))


def _answering(
    table: Table, to: Stimulus, text: str, reply: Callable[[Codec, bytes], bytes]
) -> Mutant:
    return _plain(table, f"in reply to {to}, {text}", lambda: RepliesToMalformed(to, reply))


def _plain(table: Table, text: str, fault: Callable[[], Fault]) -> Mutant:
    return Mutant("malformed input", "", "", text, lambda clock: BrokenArm(table, fault(), clock))


def _same(codec: Codec, data: bytes) -> bytes:
    return data


def _frame(codec: Codec, data: bytes) -> bytes:
    """Return an acknowledgement with the byte that is at the offset of the id."""
    at = data.find(codec.table.frame.header) + codec.table.frame.overhead
    return framed(codec.table.frame, data[at] if at < len(data) else data[-1], b"\x01")


# A text in reply is not a fault: firmware sends ``cmd_len error``, which no edition forbids.
ANSWERS: tuple[tuple[str, Callable[[Codec, bytes], bytes]], ...] = (
    ("the same bytes", _same),
    ("an acknowledgement", _frame),
)
