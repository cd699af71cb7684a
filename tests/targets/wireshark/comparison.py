"""Put every vector into a capture, and compare the dissector with the Python codec."""

from __future__ import annotations

import re
import shutil
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import vectors
from cobotwire.codec.interface import Codec, DecodedMessage, Frame, Listening
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Field, Number
from cobotwire_codegen.render.words import units
from strategies import codec_of
from targets.comparison import Comparison, ToolMissing
from targets.vectors.comparison import read
from targets.wireshark.captures import Chunk, serial
from targets.wireshark.dissecting import ABSENT, Item, dissected, joined
from targets.wireshark.truth import events_of, summary

# Streams are sent whole, and in pieces of seven bytes.
PIECES = (10_000, 7)


class Line(NamedTuple):
    """A vector on its own line: its chunks, and its fields if it is a text."""

    name: str
    direction: Listening
    chunks: list[bytes]
    text: dict[str, str] = {}  # noqa: RUF012  (never changed)
    # The request for a text, in the other direction.
    text_request: bytes = b""


class Check(NamedTuple):
    """One comparison: the difference, empty if there is none; whether a field was compared."""

    difference: str
    is_field: bool = False


def compare(edition: str) -> Comparison:
    """Run every vector of an edition through tshark with our dissector.

    Raises:
        ToolMissing: tshark is not installed.
    """
    if shutil.which("tshark") is None:
        raise ToolMissing(ABSENT)
    return compared(list(lines_of(edition)), codec_of(edition, "reference"))


def compared(lines: list[Line], codec: Codec, scripts: list[Path] | None = None) -> Comparison:
    """Run lines through tshark, all at once."""
    edition = codec.table.edition
    chunks = [chunk for number, line in enumerate(lines) for chunk in _chunks(number, line)]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "vectors.pcapng"
        path.write_bytes(serial(chunks, edition))
        packets = dissected(path, edition, scripts=scripts)
    shown: dict[int, list[list[Item]]] = defaultdict(list)
    for chunk, items in zip(chunks, packets, strict=True):
        if chunk.direction == lines[chunk.line].direction:
            shown[chunk.line].append(items)
    fields, differences = 0, []
    for number, line in enumerate(lines):
        judged = list(_judge(line, codec, shown[number]))
        fields += sum(check.is_field for check in judged)
        differences += [f"{line.name}: {check.difference}" for check in judged if check.difference]
    return Comparison(len(lines), fields, differences)


def _chunks(number: int, line: Line) -> Iterator[Chunk]:
    if line.text_request:
        yield Chunk(number, "request", line.text_request)
    for data in line.chunks:
        yield Chunk(number, line.direction, data)


def lines_of(edition: str) -> Iterator[Line]:
    """Return the spec's own vectors and the shared ones."""
    for name, vector in vectors.every():
        printed = vector.frame or vector.printed
        if name == edition and printed is not None:
            yield Line(vector.name, vector.direction, [printed])
        elif name == edition and vector.text is not None:
            fields = {key: str(value) for key, value in vector.values}
            yield _text(edition, vector.command, vector.direction, vector.text.encode(), fields)
    document = read(edition)
    for part in ("messages", "malformed"):
        for record in document[part]:
            name = f"{part}: {record.get('name')}"
            if data := bytes.fromhex(record["bytes"]):
                yield Line(name, record["direction"], [data])
    for record in document["streams"]:
        data = bytes.fromhex(record["bytes"])
        for size in PIECES:
            pieces = [data[at : at + size] for at in range(0, len(data), size)]
            yield Line(f"{record['name']} by {size}", record["direction"], pieces)
    for record in document["texts"]:
        data = bytes.fromhex(record["bytes"])
        yield _text(edition, record["command"], record["direction"], data, record["fields"])


def _text(
    edition: str, name: str, direction: Listening, data: bytes, fields: dict[str, str]
) -> Line:
    """Return a text on a line, after its request."""
    frame = codec_of(edition, "reference").encode(name, "request", ())
    if direction == "request":
        return Line(f"text of {name}", direction, [frame, data], fields)
    return Line(f"text of {name}", direction, [data], fields, frame)


def _judge(line: Line, codec: Codec, packets: list[list[Item]]) -> Iterator[Check]:
    """Yield every comparison of a line."""
    truth = events_of(codec, line.direction, ((chunk, False) for chunk in line.chunks))
    wanted = summary(truth, b"".join(line.chunks))
    found = joined(packets)
    yield Check("" if found == wanted else f"events {found}, not {wanted}")
    frames = [event for event in truth[0] if isinstance(event, Frame)]
    items = [item for packet in packets for item in packet]
    for frame, item in zip(frames, (item for item in items if item.kind == "frame")):
        yield from _frame(frame, item, codec, line.direction)
    for name, value in line.text.items():
        shown = {leaf.filter: leaf.value for leaf in items[-1].leaves}
        same = shown.get(f"text.{name}") == value
        yield Check("" if same else f"{name}: {shown}, not {value!r}", is_field=True)


def _frame(frame: Frame, item: Item, codec: Codec, direction: Listening) -> Iterator[Check]:
    same = int(item.own["frame.id"], 16) == frame.command
    yield Check("" if same else f"CMD {item.own['frame.id']}")
    try:
        message = frame.message
    except ProtocolError as error:
        fits = error.reason == "bad-value" and "bad_value" in item.experts
        yield Check("" if fits else f"{item.experts}, not {error}")
        return
    yield Check("" if not item.experts else f"{item.experts}")
    named = item.own["frame.command"], item.own["frame.direction"]
    same = named == (message.command.name, message.direction)
    yield Check("" if same else f"{named}, not {message.command.name}")
    numbers = list(_numbers(message, frame.data, codec.table.frame.overhead + 1))
    yield Check("" if len(numbers) == len(item.leaves) else f"{len(item.leaves)} numbers")
    for leaf, (field, number, value, data) in zip(item.leaves, numbers):
        name = number.name or field.name
        words = _label(name, field, number, value)
        shown = leaf.filter.split(".")[-1], _value(leaf.value), leaf.data
        label = re.sub(r" \[-?\d+ on the wire\]| \[echo of the request\]$", "", leaf.label)
        # Wireshark shows 15 digits, and the editions' values have no more.
        digits = float(f"{value:.15g}")
        same = shown == (name, digits, data) and label == words
        difference = f"{name}: {shown} {label!r}, not {value} {data.hex()} {words!r}"
        yield Check("" if same else difference, is_field=True)


def _numbers(
    message: DecodedMessage, frame: bytes, at: int
) -> Iterator[tuple[Field, Number, Any, bytes]]:
    for field, value in zip(message.variant.fields, message.values):
        numbers = message.variant.case(field, message.values).numbers
        for number, part in zip(numbers, value if field.many else [value]):
            yield field, number, part, frame[at : at + number.width]
            at += number.width


def _label(name: str, field: Field, number: Number, value: Any) -> str:
    if field.labels:
        return f"{name}: {field.labels[field.choices.index(value)]} ({value})"
    if field.kind == "flag":
        return f"{name}: {'yes' if value else 'no'}"
    unit = f" {units(number.unit)}" if number.unit else ""
    return f"{name}: {value:.15g}{unit}"


def _value(shown: str) -> float:
    # A boolean is 1 or 0; later versions of Wireshark write a word.
    return float({"True": "1", "False": "0"}.get(shown, shown))
