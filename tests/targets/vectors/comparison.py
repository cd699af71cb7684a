"""Compare our codecs with the shared vectors, as a test of any implementation can do."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from functools import partial
from itertools import chain
from typing import Any

from cobotwire.codec.interface import Codec, Event, Noise
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Field, Number, Variant
from cobotwire.session import text
from framed_events import joined
from strategies import CODECS, codec_of
from targets.built import built
from targets.comparison import Comparison, compared

Record = dict[str, Any]
# A stream is fed in pieces of these sizes: byte by byte, in few bytes, and whole.
PIECES = (1, 2, 7, 1000)


def read(edition: str) -> Record:
    """Return an edition's document."""
    found: Record = json.loads((built("vectors") / f"{edition}.json").read_text(encoding="utf-8"))
    return found


def sample(edition: str, command: str) -> Record:
    """Return every ninth vector of an edition's document, and every vector of one command."""
    document = read(edition)
    parts = ("messages", "rejected", "malformed", "streams", "texts")
    return document | {
        part: [
            record
            for at, record in enumerate(document[part])
            if at % 9 == 0 or record.get("command") == command
        ]
        for part in parts
    }


def compare(edition: str) -> Comparison:
    """Run an edition's document on both codecs."""
    document = read(edition)
    found = [validated(document, codec_of(edition, name)) for name in CODECS]
    return Comparison(
        sum(each.vectors for each in found),
        sum(each.fields for each in found),
        [difference for each in found for difference in each.differences],
        sum(each.refused for each in found),
    )


def validated(document: Record, codec: Codec) -> Comparison:
    """Run the document on one codec."""
    parts = {
        "messages": _message,
        "rejected": _rejected,
        "malformed": _malformed,
        "streams": _stream,
        "texts": _text,
    }
    return compared(document, {part: partial(each, codec=codec) for part, each in parts.items()})


def _message(record: Record, codec: Codec) -> Iterator[str]:
    data = bytes.fromhex(record["bytes"])
    variant = _variant(record, codec)
    values = _values(record, variant.fields)
    try:
        built = _built(record, codec)
        read = codec.decode(record["direction"], data, of=record["command"])
        named = codec.decode(record["direction"], data).command.name
    except (UsageError, ProtocolError) as error:
        yield f"rejected: {error}"
        return
    if built != data:
        yield f"built {built.hex(' ')}, not {data.hex(' ')}"
    if read.variant == variant and _exact(read.values) != _exact(values):
        yield f"read {read.values}, not {values}"
    if named != record["read_as"]:
        yield f"read as {named}, not {record['read_as']}"


def _exact(value: Any) -> Any:
    """Return a value in which 0.0 and -0.0 differ, and NaN equals NaN: both become texts."""
    if isinstance(value, tuple):
        return tuple(map(_exact, value))
    return repr(value) if isinstance(value, float) and (value == 0 or value != value) else value


def _variant(record: Record, codec: Codec) -> Variant:
    variants = codec.table.command(record["command"]).variants(record["direction"])
    if not any(field.sizes for variant in variants for field in variant.fields):
        return variants[record["variant"]]
    # Our table has a variant for each number of elements.
    sizes = [len(field["raw"]) for field in record["fields"]]
    return next(each for each in variants if sizes == [_size(field) for field in each.fields])


def _size(field: Field) -> int:
    return len(field.cases[0].numbers)


def _built(record: Record, codec: Codec) -> bytes:
    """Return the frame that the codec encodes from a record's values."""
    variant = _variant(record, codec)
    command, direction = record["command"], record["direction"]
    variants = codec.table.command(command).variants(direction)
    number = next(index for index, each in enumerate(variants) if each is variant)
    return codec.encode(command, direction, _values(record, variant.fields), variant=number)


def _rejected(record: Record, codec: Codec) -> Iterator[str]:
    try:
        built = _built(record, codec)
    except UsageError as error:
        if not error.argument.startswith(record["field"]):
            yield f"rejected for {error.argument}, not for {record['field']}"
    else:
        yield f"built {built.hex(' ')}"


def _malformed(record: Record, codec: Codec) -> Iterator[str]:
    try:
        message = codec.decode(record["direction"], bytes.fromhex(record["bytes"]))
    except ProtocolError as error:
        found = (error.reason, error.offset)
        if found != (record["reason"], record["offset"]):
            yield f"{found}, not {(record['reason'], record['offset'])}"
    else:
        yield f"read as {message.values}"


def _stream(record: Record, codec: Codec) -> Iterator[str]:
    data = bytes.fromhex(record["bytes"])
    for size in PIECES:
        framer = codec.framer(record["direction"])
        pieces = (data[at : at + size] for at in range(0, len(data), size))
        events = chain.from_iterable(map(framer.feed, pieces))
        found = as_written([*events, *framer.flush()])
        if found != record["events"]:
            yield f"in pieces of {size}: {found}, not {record['events']}"


def as_written(events: list[Event]) -> list[Record]:
    """Return events as the document writes them: adjacent noise of one reason is one span."""
    return [
        {"offset": event.offset, "size": len(event.data)}
        | ({"noise": event.reason} if isinstance(event, Noise) else {"frame": event.command})
        for event in joined(events)
    ]


def _text(record: Record, codec: Codec) -> Iterator[str]:
    command = codec.table.command(record["command"])
    variant = command.request_text if record["direction"] == "request" else command.text
    data = bytes.fromhex(record["bytes"])
    if variant is None or text.encode(variant, record["fields"]) != data:
        yield "encoded differently"
    elif text.decode(variant, data) != record["fields"]:
        yield "read differently"


def _values(record: Record, fields: Any) -> tuple[Any, ...]:
    given = {field["name"]: field for field in record["fields"]}
    return tuple(_value(field, given[field.name]) for field in fields)


def _value(field: Field, given: Record) -> Any:
    """Return a field's value as our codec has it."""
    if "text" in given:
        return tuple(given["text"]) if field.each else given["text"]
    numbers = [
        _plain(field, number, value) for number, value in zip(_numbers(field), given["value"])
    ]
    if not field.many:
        return numbers[0]
    if field.kind == "bytes":
        return bytes(numbers) if all(0 <= byte < 256 for byte in numbers) else tuple(numbers)
    each = field.each or len(numbers)
    groups = tuple(tuple(numbers[at : at + each]) for at in range(0, len(numbers), each or 1))
    return groups if field.each else tuple(numbers)


def _numbers(field: Field) -> Iterable[Number]:
    """Return the numbers of a field; in each case they have the same kinds."""
    return max((case.numbers for case in field.cases), key=len)


def _plain(field: Field, number: Number, value: Any) -> Any:
    kind = number.kind if number.bits else field.kind
    if isinstance(value, str):
        return float(value)
    return bool(value) if kind == "flag" and value in (0, 1) else value
