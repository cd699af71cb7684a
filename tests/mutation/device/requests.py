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
from mutation.device.broken import Fault, Mutant
from mutation.device.cells import (
    STIMULI,
    Cell,
    Stimulus,
    framed,
    joined,
    replier,
    take_apart,
)
from mutation.device.exchanges import distinct, next_value, pickers, request_fields


def _ignored(command: Command) -> Fault:
    """Reply to one setter with the first variant and its usual value, but do not carry it out."""

    def reply(table: Table, request: DecodedMessage, data: bytes) -> bytes:
        if request.command is not command or not command.reply:
            return data
        fields = [
            [Cell(number, number.clamp(1)) for number in field.cases[0].numbers]
            for field in command.reply[0].fields
        ]
        address = replier(table, request.address)
        return framed(table.frame, command.id, joined(fields), address)

    return Fault(request=lambda _, r, data: b"" if r.command is command else data, reply=reply)


def _misread(command: Command, field: Field, change: Callable[[Cell], int]) -> Fault:
    """Misread one field of one request, if that is legal; reply with the fields that were sent."""

    def changed(cell: Cell) -> Cell:
        raw = change(cell)
        return replace(cell, raw=raw if field.choices else cell.number.clamp(raw))

    def request(table: Table, request: DecodedMessage, data: bytes) -> bytes:
        if request.command is not command:
            return data
        fields = take_apart(table.frame, request, data)
        for at, each in enumerate(request.variant.fields):
            if each.name == field.name:
                fields[at] = list(map(changed, fields[at]))
        misread = framed(table.frame, command.id, joined(fields), request.address)
        return misread if _is_legal(codecs.load(table), command, misread) else data

    return Fault(request=request)


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
        yield Mutant("ignored", "", partial(_ignored, command), command.name)
        for field in request_fields(command):
            for kind, text, change in _misreadings(field, parts):
                fault = partial(_misread, command, field, change)
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


def _goes_silent(after: Stimulus, requests: int | None) -> Fault:
    """After some malformed input, the next requests (None: all) get no reply."""
    left: int | None = 0

    def malformed(table: Table, kind: Stimulus, data: bytes) -> bytes:
        nonlocal left
        left = requests if kind == after else left
        return b""

    def request(table: Table, request: DecodedMessage, data: bytes) -> bytes:
        nonlocal left
        if left == 0:
            return data
        left = None if left is None else left - 1
        return b""

    return Fault(malformed=malformed, request=request)


def _replies_to_malformed(to: Stimulus, reply: Callable[[Table, bytes], bytes]) -> Fault:
    return Fault(malformed=lambda table, kind, data: reply(table, data) if kind == to else b"")


def _receives_few_per_write(most: int) -> Fault:
    """Receive only the first requests of a write."""
    received: list[bytes] = []

    def request(table: Table, request: DecodedMessage, data: bytes) -> bytes:
        received.append(data)
        return data if len(received) <= most else b""

    return Fault(chunk=lambda _: received.clear(), request=request)


def _needs_whole_writes(writes: int) -> Fault:
    """Receive no request that arrives in more writes."""
    sizes: list[int] = []

    def request(table: Table, request: DecodedMessage, data: bytes) -> bytes:
        return data if sum(sizes[-writes:]) >= len(data) else b""

    return Fault(chunk=lambda data: sizes.append(len(data)), request=request)


def _forgets(after: Stimulus, request: bytes) -> Fault:
    """After some malformed input, one setting has its simplest value again."""
    return Fault(forgets=lambda kind: request if kind == after else b"")


def breaks_on_malformed(table: Table) -> Iterator[Mutant]:
    """Yield a mutant for each kind of malformed input and each way to break on it."""
    for stimulus in STIMULI:
        for text, requests in SILENCES:
            yield _malformed(f"after {stimulus}, {text}", partial(_goes_silent, stimulus, requests))
        for text, reply in ANSWERS:
            fault = partial(_replies_to_malformed, stimulus, reply)
            yield _malformed(f"in reply to {stimulus}, {text}", fault)
    for most in (1, 2):
        text = f"at most {most} of the requests in one write are received"
        yield _malformed(text, partial(_receives_few_per_write, most))
    for writes in (1, 2):
        text = f"a request in more than {writes} writes is not received"
        yield _malformed(text, partial(_needs_whole_writes, writes))


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
            fault = partial(_forgets, after, data)
            yield Mutant("state lost", f"after {after}", fault, command.name)
