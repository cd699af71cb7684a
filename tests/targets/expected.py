"""Vectors made with the reference codec, for targets that tests compare on any protocol."""

from __future__ import annotations

import json
from math import isfinite
from typing import Any

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.loading import table_of
from cobotwire.protocol.table import Direction, Field, Variant
from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from targets.vectors.comparison import Record, joined


def codec_of_edition(edition: Edition, name: codecs.CodecName = "reference") -> Codec:
    """Return a codec of an edition of the generator."""
    return codecs.load(table_of(json.loads(edition_json(edition))), name)


# UTF-8 at its limits: surplus bytes, surrogates, beyond U+10FFFF, cut characters.
_UTF8 = """
    C1 BF, C2 80, DF BF, E0 9F BF, E0 A0 80, ED 9F BF, ED A0 80, EE 80 80, F0 8F BF BF, F0 90 80 80,
    F4 8F BF BF, F4 90 80 80, F5 80 80 80, 80, C3, E2 82, F0 9F 98, 61 C3 28, E2 82 AC C3 A9 FF
"""


def frames_with_odd_texts(codec: Codec) -> list[bytes]:
    """Return replies of the made-up sensor that end with bytes that are, or are not, UTF-8."""
    texts = [bytes.fromhex(text) for text in _UTF8.split(",")]
    return [codec.table.frame.enclose(0x26, bytes(12) + text) for text in texts]


class Document:
    """Vectors of one edition in the format of ``docs/vectors.md``, as our codec decides them."""

    def __init__(self, edition: Edition) -> None:
        self.codec = codec_of_edition(edition)
        self.record: Record = {"edition": edition.name, "messages": [], "malformed": []}
        self.record["streams"] = []

    def add(self, direction: Direction, data: bytes) -> None:
        """Add bytes that should be a frame: a message or malformed bytes."""
        record: Record = {"name": data.hex(" "), "direction": direction, "bytes": data.hex(" ")}
        try:
            found = self.codec.decode(direction, data)
        except ProtocolError as error:
            self.record["malformed"].append(
                record | {"reason": error.reason, "offset": error.offset}
            )
            return
        variants = found.command.variants(direction)
        number = next(i for i, each in enumerate(variants) if each is found.variant)
        varies = any(field.sizes for field in found.variant.fields)
        self.record["messages"].append(
            record
            | {
                "command": found.command.name,
                "read_as": found.command.name,
                # In the spec, messages with other numbers of elements are the same variant.
                "variant": 0 if varies else number,
                "fields": self._fields(found.variant, found.values, data, direction),
            }
        )

    def stream(self, listening: Listening, data: bytes) -> None:
        """Add a stream and the events in it."""
        framer = self.codec.framer(listening)
        events = joined([*framer.feed(data), *framer.flush()])
        name = data.hex(" ")
        self.record["streams"].append(
            {"name": name, "direction": listening, "bytes": name, "events": events}
        )

    def _fields(
        self, variant: Variant, values: tuple[Any, ...], data: bytes, direction: Direction
    ) -> list[Record]:
        rows = variant.unpack(self.codec.table.frame.data(data, direction))
        return [
            {"name": field.name, "raw": list(row), "value": _numbers(variant, field, rows)}
            | ({"text": _texts(field, value)} if field.kind == "text" else {})
            for field, row, value in zip(variant.fields, rows, values)
        ]


def _numbers(variant: Variant, field: Field, rows: list[tuple[int, ...]]) -> list[Any]:
    case = variant.raw_case(field, rows)
    assert case is not None, "the message is legal"
    row = rows[variant.fields.index(field)]
    return [_written(number.physical(raw)) for number, raw in zip(case.numbers, row)]


def _written(value: float) -> float | str:
    """Return a number as JSON and JavaScript can write it."""
    if isfinite(value):
        return value
    return "NaN" if value != value else f"{'-' if value < 0 else ''}Infinity"


def _texts(field: Field, value: Any) -> list[str]:
    return list(value) if field.each else [value]
