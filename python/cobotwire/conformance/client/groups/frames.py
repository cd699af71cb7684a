"""A client sends whole frames with legal values, one after the other, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cobotwire.codec.interface import Codec, NoiseReason
from cobotwire.conformance.client.broken_frames import described, meant
from cobotwire.conformance.client.history import History, Received
from cobotwire.conformance.located import located_numbers
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.conformance.tally import Observation
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Field, Table

FRAMING = "docs/framing.md"

LENGTH = TestCase("frame-length", "LEN is legal for the command.", FRAMING)
ID = TestCase("frame-id", "The id belongs to a command of the edition.", FRAMING)
FOOTER = TestCase("frame-footer", "A frame ends with its footer, or the right check.", FRAMING)
ADDRESS = TestCase("frame-address", "The address byte is one that the edition has.", FRAMING)
WHOLE = TestCase("frame-whole", "A frame is sent whole, without a pause.", FRAMING)
STRAY = TestCase("stray-bytes", "No byte lies outside a frame.", FRAMING)
INTERLEAVED = TestCase(
    "interleaved-write", "No frame is written into another one.", "field notes: two writers"
)
TEXT_FOLLOWS = TestCase(
    "text-follows", "The text of a request follows it at once.", "spec: request text"
)
TABLE = "the edition's table"
RANGE = TestCase("value-range", "A number is within the range of its field.", TABLE)
LISTED = TestCase("value-listed", "A value of a closed list is one of the list.", TABLE)

# For each reason of noise: the test case that the bytes fail.
BY_REASON: Mapping[NoiseReason, TestCase] = {
    "bad-length": LENGTH,
    "unknown-id": ID,
    "bad-check": FOOTER,
    "bad-address": ADDRESS,
    "truncated": WHOLE,
    "no-header": STRAY,
}


def _framing(history: History, now: Received) -> Iterator[Observation]:
    """Check noise by the reason why its bytes are not a frame."""
    if now.noise is None:
        yield from (Observation(case) for case in BY_REASON.values())
        return
    case = BY_REASON[now.noise.reason]
    if case is not STRAY or not _explained(history):
        commands = [] if case is STRAY else meant(history.codec.table, now.data)
        name = commands[0].name if commands else ""
        yield Observation(case, described(history.codec.table, now.noise), name)


def _explained(history: History) -> bool:
    """Return whether stray bytes are a request's text or the remainder of a broken frame."""
    last = history.last
    return history.missing_text() is not None or (last is not None and last.noise is not None)


def _interleaving(history: History, now: Received) -> Iterator[Observation]:
    """Report an interleaved write if removing one legal frame leaves another one."""
    complaint = ""
    if now.noise is not None:
        recent = _recent_bytes(history, now)
        pairs = (pair for at in range(len(recent)) for pair in _pairs(history.codec, recent[at:]))
        outer, inner = next(pairs, (b"", b""))
        if inner:
            complaint = f"{inner.hex(' ').upper()} was written into {outer.hex(' ').upper()}"
    yield Observation(INTERLEAVED, complaint)


def _recent_bytes(history: History, now: Received) -> bytes:
    """Return the most recent bytes, up to the length of two frames."""
    data = now.data
    frame = history.codec.table.frame
    most = 2 * (frame.overhead + frame.maximum_length)
    for entry in history.since(now.at - 1.0):
        data = entry.data + data
        if len(data) > most:
            break
    return data[-most:]


def _pairs(codec: Codec, data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield each pair of an outer and an inner frame that together make up ``data``."""
    frame = codec.table.frame
    if not data.startswith(frame.header):
        return
    for at in range(1, len(data) - frame.head_size + 1):
        if data[at : at + len(frame.header)] != frame.header:
            continue
        end = at + frame.overhead + frame.read_length(data, at)
        outer, inner = data[:at] + data[end:], data[at:end]
        if end < len(data) and _legal(codec, inner) and _legal(codec, outer):
            yield outer, inner


def _legal(codec: Codec, data: bytes) -> bool:
    try:
        codec.decode("request", data)
    except ProtocolError:
        return False
    return True


def missing_text(request: Received) -> Observation:
    """Return the failure of a request without the text that must follow it."""
    complaint = f"{request.name} lacks the text after it, or the text is illegible"
    return Observation(TEXT_FOLLOWS, complaint, request.name)


def _texts(history: History, now: Received) -> Iterator[Observation]:
    """Check a frame that comes where a text is due."""
    due = history.missing_text()
    if now.is_frame and due is not None:
        yield missing_text(due)


def _values(history: History, now: Received) -> Iterator[Observation]:
    """Check a frame that is legal except for a value; a wrong scale often shows here."""
    if now.error is not None:
        field = _field_at(history.codec.table, now.data, now.error.offset)
        listed = field is not None and bool(field.choices)
        yield Observation(LISTED if listed else RANGE, str(now.error))
    elif now.is_frame:
        yield from (Observation(RANGE), Observation(LISTED))


def _field_at(table: Table, data: bytes, offset: int) -> Field | None:
    """Return the field at an offset of a frame."""
    frame = table.frame
    size = len(frame.data(data))
    for command in table.commands:
        for variant in command.request if command.id == frame.read_id(data) else ():
            for located in located_numbers(variant) if variant.size == size else ():
                if 0 <= offset - frame.data_at - located.start < located.number.width:
                    return located.field
    return None


FRAMES = Group(
    "frames",
    (LENGTH, ID, FOOTER, ADDRESS, WHOLE, STRAY),
    _framing,
    subject="everything that the client sends",
)
INTERLEAVED_WRITES = Group(
    "interleaved writes", (INTERLEAVED,), _interleaving, subject="everything that the client sends"
)
TEXTS = Group("texts", (TEXT_FOLLOWS,), _texts, subject="each request that a text follows")
VALUES = Group("values", (RANGE, LISTED), _values, subject="each legal frame")
