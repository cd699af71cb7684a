"""Devices that misread or lose requests, or break on bytes that are not a legal request."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.conformance.device.requests import gentle
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Command, Field, Table
from cobotwire.session.request import RequestEncoder
from mutation.device.broken import Fault, Mutant, TimedBytes
from mutation.device.cells import Cell, framed, joined, replier, take_apart
from mutation.device.exchanges import distinct, next_value, pickers, request_fields
from mutation.device.stimulus import STIMULI, Stimulus


class Ignored(Fault):
    """One setter gets its reply, but is not carried out."""

    def __init__(self, command: Command) -> None:
        self._command = command

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return nothing, so that the arm does not receive the request."""
        return b"" if request.command is self._command else data

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the acknowledgement, or the first variant of the reply with its usual value."""
        if request.command is not self._command or not self._command.reply:
            return [TimedBytes(0.0, data)]
        fields = [
            [Cell(number, min(max(1, number.minimum), number.maximum)) for number in numbers]
            for numbers in (field.cases[0].numbers for field in self._command.reply[0].fields)
        ]
        address = replier(codec.table, request.address)
        reply = framed(codec.table.frame, self._command.id, joined(fields), address)
        return [TimedBytes(0.0, reply)]


class Misread(Fault):
    """One field of one request is misread; the reply has the fields that were sent."""

    def __init__(self, command: Command, field: Field, change: Callable[[Cell], int]) -> None:
        self._command = command
        self._field = field
        self._change = change

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return the request with its field changed, unless that is not legal."""
        if request.command is not self._command:
            return data
        frame = codec.table.frame
        fields = take_apart(frame, request, data)
        for at, field in enumerate(request.variant.fields):
            if field.name == self._field.name:
                fields[at] = [self._changed(cell) for cell in fields[at]]
        changed = framed(frame, request.command.id, joined(fields), request.address)
        return changed if _is_legal(codec, request.command, changed) else data

    def _changed(self, cell: Cell) -> Cell:
        raw = self._change(cell)
        return replace(cell, raw=raw if self._field.choices else cell.number.clamp(raw))


def _is_legal(codec: Codec, command: Command, data: bytes) -> bool:
    try:
        return codec.decode("request", data, of=command.name).command is command
    except ProtocolError:
        return False


def wrong_setters(table: Table) -> Iterator[Mutant]:
    """Yield a mutant that ignores, and mutants that misread each field of, every setter."""
    parts = pickers(table)
    for command in distinct(table):
        if command.safety == "query":
            continue
        yield Mutant("ignored", "", partial(Ignored, command), command.name)
        for field in request_fields(command):
            for kind, text, change in _misreadings(field, parts):
                fault = partial(Misread, command, field, change)
                yield Mutant(kind, text, fault, command.name, field.name)


def _misreadings(field: Field, parts: set[str]) -> Iterator[tuple[str, str, Callable[[Cell], int]]]:
    if field.choices and len(field.choices) < 2:
        return
    if field.name in parts:
        yield "wrong part", "the next part instead", partial(next_value, field)
    elif field.choices:
        yield "stored wrong", "as the next legal value", partial(next_value, field)
    else:
        yield "stored wrong", "a tenth of it", lambda cell: -(-cell.raw // 10)
        yield "stored wrong", "half of it", lambda cell: -(-cell.raw // 2)
        if any(number.minimum < 0 for case in field.cases for number in case.numbers):
            yield "stored wrong", "without its sign", lambda cell: abs(cell.raw)


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

    def __init__(self, to: Stimulus, reply: Callable[[Table, bytes], bytes]) -> None:
        self._to = to
        self._reply = reply

    def malformed(self, codec: Codec, kind: Stimulus, data: bytes) -> bytes:
        """Return the reply."""
        return self._reply(codec.table, data) if kind == self._to else b""


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
        return data if sum(self._sizes[-self._writes :]) >= len(data) else b""


class Forgets(Fault):
    """After some malformed input, one setting has its simplest value again."""

    def __init__(self, after: Stimulus, request: bytes) -> None:
        self._after = after
        self._request = request

    def forgets(self, kind: Stimulus) -> bytes:
        """Return the request that sets the simplest value."""
        return self._request if kind == self._after else b""


def breaks_on_malformed(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each kind of malformed input and each way to break on it."""
    for stimulus in STIMULI:
        for text, requests in SILENCES:
            yield _malformed(f"after {stimulus}, {text}", partial(GoesSilent, stimulus, requests))
        for text, reply in ANSWERS:
            fault = partial(RepliesToMalformed, stimulus, reply)
            yield _malformed(f"in reply to {stimulus}, {text}", fault)
    for most in (1, 2):
        text = f"at most {most} of the requests in one write are received"
        yield _malformed(text, partial(ReceivesFewPerWrite, most))
    for writes in (1, 2):
        text = f"a request in more than {writes} writes is not received"
        yield _malformed(text, partial(NeedsWholeWrites, writes))


def _malformed(text: str, fault: Callable[[], Fault]) -> Mutant:
    return Mutant("malformed input", text, fault)


def _ack(table: Table, data: bytes) -> bytes:
    """Return an acknowledgement with the byte that is at the offset of the id."""
    at = data.find(table.frame.header) + table.frame.overhead
    return framed(table.frame, data[at] if at < len(data) else data[-1], b"\x01")


SILENCES = (
    ("the device sends no more replies", None),
    ("the next good request is lost", 1),
    ("the next two good requests are lost", 2),
)
# A text in reply is not a fault: firmware sends ``cmd_len error``, which no edition forbids.
ANSWERS: tuple[tuple[str, Callable[[Table, bytes], bytes]], ...] = (
    ("the same bytes", lambda table, data: data),
    ("an acknowledgement", _ack),
)


def loses_state(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each setting that a query reads, and each kind of malformed input."""
    encoder = RequestEncoder(codecs.load(table), None)
    for command in distinct(table):
        if command.safety != "setting" or command.read_by is None or command.request_text:
            continue
        try:
            data = encoder.encode_request(gentle(command)).frame
        except UsageError:
            continue
        for after in STIMULI:
            fault = partial(Forgets, after, data)
            yield Mutant("state lost", f"after {after}", fault, command.name)
