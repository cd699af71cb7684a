"""Make vectors with the reference codec, so that tests can compare targets on any protocol."""

from __future__ import annotations

import json
import re
from itertools import chain
from math import isfinite
from typing import Any

from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening
from cobotwire.diagnose.explain import Part, frame_parts
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.loading import table_of
from cobotwire.protocol.table import Direction, Field, Variant
from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from raw_messages import raw_messages
from strategies import CommandVariant
from targets.vectors.comparison import Record, as_written

LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])
# UTF-8 at its limits: surplus bytes, surrogates, beyond U+10FFFF, cut characters.
_UTF8 = """
    C1 BF, C2 80, DF BF, E0 9F BF, E0 A0 80, ED 9F BF, ED A0 80, EE 80 80, F0 8F BF BF, F0 90 80 80,
    F4 8F BF BF, F4 90 80 80, F5 80 80 80, 80, C3, E2 82, F0 9F 98, 61 C3 28, E2 82 AC C3 A9 FF
"""


def codec_of_edition(edition: Edition, name: codecs.CodecName = "reference") -> Codec:
    """Return a codec for an edition in the generator's model."""
    return codecs.load(table_of(json.loads(edition_json(edition))), name)


class Document:
    """Vectors of one edition in the format of ``docs/vectors.md``, with the results of our codec.

    The section ``encoded`` exists only here: physical values, with their frame or with the field
    that is rejected.
    """

    def __init__(self, edition: Edition, codec: Codec | None = None) -> None:
        self.codec = codec or codec_of_edition(edition)
        self.edition = edition.name
        self.clear()

    def clear(self) -> None:
        """Remove all vectors."""
        parts = ("messages", "rejected", "malformed", "streams", "encoded")
        self.record: Record = {"edition": self.edition, **{part: [] for part in parts}}

    def add(self, direction: Direction, data: bytes, of: CommandVariant | None = None) -> None:
        """Add bytes that should be a frame: a message or malformed bytes.

        ``of`` is the command that the bytes are decoded as.
        """
        record: Record = {"name": data.hex(" "), "direction": direction, "bytes": data.hex(" ")}
        if of is not None:
            record |= {"command": of.command.name, "variant": _number(of.variant, of.number)}
        try:
            found = self.codec.decode(direction, data, of=of and of.command.name)
        except ProtocolError as error:
            place = {"reason": error.reason, "offset": error.offset, "rejects": _rejected(error)}
            self.record["malformed"].append(record | place)
            return
        variants = found.command.variants(direction)
        number = next(i for i, each in enumerate(variants) if each is found.variant)
        # Damage may have set bits that belong to no field; encoding clears them.
        name, address = found.command.name, self.codec.table.frame.address(data)
        built = self.codec.encode(name, direction, found.values, variant=number, address=address)
        self.record["messages"].append(
            record
            | {
                "built": built.hex(" "),
                "command": name,
                "read_as": self.codec.decode(direction, data).command.name,
                "variant": _number(found.variant, number),
                "fields": self._fields(found.variant, found.values, data, direction),
                "parts": [
                    [part.offset, len(part.data), part.name, part.meaning, _raw(part)]
                    for part in frame_parts(self.codec.table, data, found)
                ],
            }
        )

    def add_odd_texts(self) -> None:
        """Add replies of the made-up sensor with texts in valid and in invalid UTF-8."""
        for text in _UTF8.split(","):
            data = bytes(12) + bytes.fromhex(text)
            self.add("reply", self.codec.table.frame.enclose(0x26, data))

    def encode(self, of: CommandVariant, values: tuple[Any, ...]) -> None:
        """Add the frame of physical values, or the field and the element that is rejected."""
        rows = [
            field.flatten(value, len(field.cases[0].numbers))
            for field, value in zip(of.variant.fields, values)
        ]
        record: Record = {
            "name": f"{of.command.name}{values}",
            "command": of.command.name,
            "direction": of.direction,
            "variant": _number(of.variant, of.number),
            "fields": [
                {"name": field.name, "value": list(row)}
                for field, row in zip(of.variant.fields, rows)
            ],
        }
        try:
            data = self.codec.encode(of.command.name, of.direction, values, variant=of.number)
            record["bytes"] = data.hex(" ")
        except UsageError as error:
            record["field"], record["element"] = _argument(error.argument, of.variant)
        self.record["encoded"].append(record)

    def stream(self, listening: Listening, data: bytes) -> None:
        """Add a stream and the events in it."""
        framer = self.codec.framer(listening)
        events = as_written([*framer.feed(data), *framer.flush()])
        name = data.hex(" ")
        self.record["streams"].append(
            {"name": name, "direction": listening, "bytes": name, "events": events}
        )

    def draw(self, data: st.DataObject) -> None:
        """Add a message, damaged copies of it, and a stream with other bytes between them."""
        message = data.draw(raw_messages(self.codec.table))
        frame, direction = message.frame, message.direction
        self.add(direction, frame)
        damaged = bytearray(frame)
        for _ in range(data.draw(st.integers(1, 3))):
            damaged[data.draw(st.integers(0, len(frame) - 1))] = data.draw(st.integers(0, 255))
        self.add(direction, bytes(damaged))
        # With a corrected check, most damage only changes values. A wrong check rejects the frame.
        format = self.codec.table.frame
        body = bytes(damaged[: len(frame) - format.check_size])
        self.add(direction, body + format.end(body))
        start = format.data_start(direction)
        cut = bytes(damaged[: data.draw(st.integers(start, len(frame)))])
        self.add(direction, cut)
        pieces = st.sampled_from([frame, bytes(damaged), cut, frame[:-1], format.header])
        stream = data.draw(st.lists(pieces | st.binary(max_size=4), max_size=6))
        self.stream(data.draw(LISTENING), b"".join(stream))

    def _fields(
        self, variant: Variant, values: tuple[Any, ...], data: bytes, direction: Direction
    ) -> list[Record]:
        rows = variant.unpack(self.codec.table.frame.data(data, direction))
        return [
            {"name": field.name, "raw": list(row), "value": _numbers(variant, field, rows)}
            | ({"text": list(value) if field.each else value} if field.kind == "text" else {})
            for field, row, value in zip(variant.fields, rows, values)
        ]


def _number(variant: Variant, number: int) -> int:
    """Return a variant's number in the spec, which counts all sizes of a list as one variant."""
    return 0 if any(field.sizes for field in variant.fields) else number


def _raw(part: Part) -> str:
    # As a text, since the raw value of a float may have 64 bits.
    return "" if part.raw is None else str(part.raw)


def _numbers(variant: Variant, field: Field, rows: list[tuple[int, ...]]) -> list[Any]:
    case = variant.raw_case(field, rows)
    assert case is not None, "the message is legal"
    row = rows[variant.fields.index(field)]
    return [_written(number.physical(raw)) for number, raw in zip(case.numbers, row)]


def _written(value: float) -> float | str:
    """Return a number, or the name that JavaScript has for it if JSON cannot write it."""
    if isfinite(value):
        return value
    return "NaN" if value != value else f"{'-' if value < 0 else ''}Infinity"


def _rejected(error: ProtocolError) -> str:
    """Return the command and the field that an error names."""
    if error.reason != "bad-value":
        return ""
    command, _, rest = str(error).partition(": ")
    # "byte 3 of label is ...", "joints[1].angle is ..."
    field = re.split(r"[.\[]", rest.partition(" is ")[0].rpartition(" of ")[2])[0]
    return f"{command}: {field}"


def _argument(argument: str, variant: Variant) -> tuple[str, int]:
    """Return the field and the index of its element that an argument's name refers to."""
    for field in variant.fields:
        # Each case has its own names for its elements.
        for element, number in chain.from_iterable(enumerate(c.numbers) for c in field.cases):
            part = f".{number.name}" if number.name else f"[{element}]"
            if argument == field.name + (part if field.many else ""):
                return field.name, element
    return argument, 0
