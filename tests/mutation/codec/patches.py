"""Codecs with one fault each: the reference codec, with one passage of its source replaced."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import Any

from cobotwire.codec import reference
from cobotwire.codec.interface import Codec, Listening
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json, hexed
from cobotwire.protocol.checks import Check
from cobotwire.protocol.table import Table
from mutation.device.cells import Edit, with_address, with_length

# A place: a module of the reference codec, and a passage that it contains once.
CHECK = "validator", 'return size if rest[end:size] == frame.end(rest[:end]) else "bad-check"'
KNOWN = "validator", 'return None if self.accept_unknown else "unknown-id"'
LENGTH = "validator", 'heading.id) for index in self.indexes):\n            return "bad-length"'
HEADER = "validator", "if not frame.header.startswith(rest[: len(frame.header)]):"
ADDRESS = "validator", "bad = at is not None and at < size and rest[at] not in self._addresses"
SKIP = "framer", "return 1"
FED = "framer", "waiting = bytearray(self._state.waiting)"
FEED = "framer", "return self._cut(bytes(waiting), at_end=False)"
FLUSH = "framer", "return self._cut(self._state.waiting, at_end=True)"
VALIDATED = "framer", "verdict = self._validator.validate(data, start)"
FRAMED = "framer", "if isinstance(verdict, int):"
FRAME = "framer", "events.append(Frame(before.offset + start, frame, id, self._read))"
NOISE = "framer", "before.offset + start, data[start:end], verdict"
NEW_NOISE = "framer", "events.append(Noise(offset, data, reason))"
CUT = "framer", "return events"
DECODED = "decode", "data = bytes(data)"
TRAILING = "decode", "if verdict < len(data):"
REJECTED_AT = "decode", "at = _rejected_at(frame, reason, data)"
REASON = "decode", "index.direction, reason, at, data)"
DECODED_VALUE = "decode", "if not field.allows(number, raw):"
ENCODED_VALUE = "encode", "if not field.allows(number, raw):"
ROUNDED = "encode", "return round(steps)"

FORGET = "self._state = self._state._replace(waiting=b'', offset=self._state.offset + self.pending)"
INNER = "any(isinstance(self._validator.validate(data[: start + verdict], i), int) for i in range("
# The faults of framers: a description, the place, and its replacement.
FLAWS = (
    ("ignores the footer", CHECK, "return size"),
    ("accepts ids that the edition lacks", KNOWN, "return None"),
    (
        "accepts any LEN of the edition for any id",
        LENGTH,
        LENGTH[1].replace('"bad-length"', "None"),
    ),
    ("checks only the first byte of the header", HEADER, "if rest[:1] != frame.header[:1]:"),
    (
        "skips the whole claimed frame if its footer is wrong",
        SKIP,
        'return 1 if reason != "bad-check" else self._validator.frame.overhead'
        " + data[start + self._validator.frame.length_at]",
    ),
    (
        "skips the whole header of a rejected frame",
        SKIP,
        'return 1 if reason == "no-header" else len(self._validator.frame.header)',
    ),
    (
        "reports all waiting bytes as noise at a silence",
        SKIP,
        'return len(data) - start if reason == "truncated" else 1',
    ),
    ("forgets the waiting bytes at a silence", FLUSH, f"{FORGET}; return []"),
    ("continues to wait at a silence", FLUSH, "return []"),
    (
        "restarts offsets after a silence",
        FLUSH,
        "events = self._cut(self._state.waiting, at_end=True)\n"
        "        self._state = self._state._replace(offset=0); return events",
    ),
    (
        "forgets the waiting bytes when a new chunk arrives",
        FED,
        f"{FORGET}; waiting = bytearray()",
    ),
    (
        "treats the end of a chunk as a silence",
        FEED,
        "return self._cut(bytes(waiting), at_end=True)",
    ),
    (
        "restarts offsets in each chunk",
        FED,
        "self._state = self._state._replace(offset=self._state.offset if self.pending else 0)\n"
        f"        {FED[1]}",
    ),
    (
        "returns a frame only after the next byte",
        FRAMED,
        f"if isinstance(verdict, int) and start + verdict == len(data) and not at_end:\n"
        f"                break\n            {FRAMED[1]}",
    ),
    (
        "flushes as soon as more than ten bytes wait",
        FEED,
        "events = self._cut(bytes(waiting), at_end=False)\n"
        "        return events + (self.flush() if self.pending > 10 else [])",
    ),
    ("does not report noise", NEW_NOISE, "pass"),
    ("gives the same reason for all noise", NOISE, NOISE[1].replace("verdict", '"no-header"')),
    (
        "reports bad-check for truncated frames",
        NOISE,
        NOISE[1].replace("verdict", '"bad-check" if verdict == "truncated" else verdict'),
    ),
    ("counts the offsets of noise from one", NOISE, NOISE[1].replace("start,", "start + 1,")),
    (
        "reports the offset of LEN as a frame's offset",
        FRAME,
        FRAME[1].replace("start,", "start + self._validator.frame.length_at,"),
    ),
    (
        "drops the last byte of a span of noise",
        CUT,
        "return [e._replace(data=e.data[:-1]) if isinstance(e, Noise) else e for e in events]",
    ),
    ("returns each frame twice", FRAME, f"{FRAME[1]}; {FRAME[1]}"),
    (
        "prefers a frame inside another one",
        VALIDATED,
        f"{VALIDATED[1]}\n            if isinstance(verdict, int) and {INNER}start + 1,"
        ' start + verdict)):\n                verdict = "bad-check"',
    ),
    (
        "rejects frames longer than sixteen bytes",
        VALIDATED,
        f"{VALIDATED[1]}\n            if isinstance(verdict, int) and verdict > 16:\n"
        '                verdict = "bad-length"',
    ),
)
# The faults of single frames, also of frames that only some formats have.
CHECKS = (
    ("ignores check and footer", CHECK, "return size"),
    ("ignores the header", HEADER, "if False:"),
    (
        "ignores LEN",
        DECODED,
        "data = bytes(data); frame = validator.frame\n    if len(data) > frame.overhead:\n"
        "        data = frame.with_length(data, len(data) - frame.overhead)",
    ),
    ("ignores bytes after the frame", TRAILING, "if False:"),
    (
        "searches the bytes for the frame",
        DECODED,
        "data = bytes(data)[max(0, bytes(data).find(validator.frame.header)) :]",
    ),
    ("ignores the command that the bytes must be", DECODED, "data, of = bytes(data), None"),
    ("ignores the address", ADDRESS, "bad = False"),
    ("reports the byte after the wrong one", REJECTED_AT, f"{REJECTED_AT[1]} + 1"),
    ("reports one reason for all", REASON, 'index.direction, "bad-check", at, data)'),
    ("truncates numbers to the lower step", ROUNDED, "return int(steps)"),
    (
        "rounds ties away from zero",
        ROUNDED,
        "return int(steps + 0.5) if steps >= 0 else -int(0.5 - steps)",
    ),
    *(
        (f"ignores {what} when it {does}", place, f"if {few} and not field.allows(number, raw):")
        for does, place in (("decodes", DECODED_VALUE), ("encodes", ENCODED_VALUE))
        for what, few in (("bounds", "field.choices"), ("lists", "not field.choices"))
    ),
)
EDITS: tuple[tuple[str, Edit], ...] = (
    ("writes another last byte", lambda _, data: data[:-1] + bytes([data[-1] ^ 1])),
    ("leaves the last byte out", lambda _, data: data[:-1]),
    ("counts the header in LEN", with_length(2)),
    ("counts a byte too few in LEN", with_length(-1)),
    ("writes one header byte", lambda _, data: data[1:]),
    ("writes one byte too many", lambda _, data: data + data[-1:]),
)
LISTENING: tuple[Listening, ...] = ("request", "reply", "both")
Make = Callable[[Table], Codec]


def patched(place: tuple[str, str], new: str, table: Table) -> Codec:
    """Return the reference codec with another passage in one place."""
    module, old = place
    source = inspect.getsource(import_module(f"{reference.__name__}.{module}"))
    assert source.count(old) == 1, place
    changed: dict[str, Any] = {"__name__": module}
    exec(source.replace(old, new), changed)
    package: dict[str, Any] = {"__name__": reference.__name__}
    exec(inspect.getsource(reference), package)
    package |= {name: changed[name] for name in package.keys() & changed.keys()}
    codec: Codec = package["ReferenceCodec"](table)
    return codec


class FramingCodec(ReferenceCodec):
    """The reference codec; one direction uses the framer of another codec or direction."""

    def __init__(self, other: Make, listening: Listening, used: Listening, table: Table) -> None:
        super().__init__(table)
        self._listening, self._used, self._other = listening, used, other(table)

    def framer(self, listening: Listening, *, accept_unknown: bool = False) -> Any:
        """Return a framer, broken for the direction of this codec."""
        if listening != self._listening:
            return super().framer(listening, accept_unknown=accept_unknown)
        return self._other.framer(self._used, accept_unknown=accept_unknown)


def broken_framers() -> Iterator[tuple[str, Make]]:
    """Yield each fault in each direction, and framers that listen to another direction."""
    for listening in LISTENING:
        for text, place, new in FLAWS:
            broken = partial(patched, place, new)
            yield f"{listening}: {text}", partial(FramingCodec, broken, listening, listening)
        for other in LISTENING:
            if other != listening:
                used = partial(FramingCodec, ReferenceCodec, listening, other)
                yield f"{listening}: listens to {other}", used


class EditedCodec(ReferenceCodec):
    """The reference codec, with an edit of the frames that it encodes."""

    def __init__(self, edit: Edit, table: Table) -> None:
        super().__init__(table)
        self._edit = edit

    def encode(self, *arguments: Any, **options: Any) -> bytes:
        """Build one frame, and edit it."""
        return self._edit(self.table, super().encode(*arguments, **options))


def wrong_frames(table: Table) -> Iterator[tuple[str, Make]]:
    """Yield each fault of single frames that the format of an edition can have."""
    check, addresses = table.frame.check, table.frame.addresses
    for text, place, new in CHECKS:
        if place != ADDRESS or addresses:
            yield text, partial(patched, place, new)
    for text, edit in EDITS:
        yield text, partial(EditedCodec, edit)
    if check is not None:
        other = "data" if check.covers_from == "command" else "command"
        yield "computes the check from another byte on", _with(check, covers_from=other)
    if check is not None and check.width > 1:
        order = "little" if check.order == "big" else "big"
        yield "swaps the bytes of the check", _with(check, order=order)
    if check is not None and check.crc is not None:
        crc = check.crc._replace(init=check.crc.init ^ 1)
        yield "begins the CRC with another value", _with(check, crc=crc)
    if addresses:
        unused = next(byte for byte in range(256) if byte not in addresses)
        edited = partial(EditedCodec, with_address(unused))
        yield "writes an address that the edition lacks", edited


def _with(check: Check, **changes: Any) -> Make:
    """Make a codec with another check."""
    other = check._replace(**changes)
    return lambda table: ReferenceCodec(table._replace(frame=table.frame._replace(check=other)))


class ReorderingCodec(OurCodec):
    """A codec that reads and writes the elements of a row in another order."""

    def __init__(
        self, table: Table, command: str, direction: str, name: str, first_two: bool
    ) -> None:
        super().__init__(ReferenceCodec(table))
        self._message, self._name, self._first_two = (command, direction), name, first_two

    def ask(self, question: Json) -> Json:
        """Return the answer, with the row reordered in the question or in the answer."""
        message = question.get("command"), question.get("direction")
        if question["do"] == "encode" and message == self._message:
            question = self._reordered_in(question)
        answer = super().ask(question)
        read = question["do"] == "decode" and (answer.get("command"), message[1]) == self._message
        return self._reordered_in(answer) if read else answer

    def _reordered_in(self, given: Json) -> Json:
        row = given["fields"].get(self._name)
        return (
            given | {"fields": given["fields"] | {self._name: self._reordered(row)}}
            if row
            else given
        )

    def _reordered(self, row: Any) -> Any:
        if isinstance(row, str):
            return hexed(bytes(self._reordered(list(bytes.fromhex(row)))))
        if not isinstance(row, list) or len(row) < 2:
            return row
        return [row[1], row[0], *row[2:]] if self._first_two else row[::-1]
