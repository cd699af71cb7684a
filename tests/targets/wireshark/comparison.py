"""Put every vector into a capture, and compare the dissector with the Python codec."""

from __future__ import annotations

import shutil
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import vectors
from cobotwire.codec.interface import Codec, DecodedMessage, Frame, Listening
from cobotwire.protocol.errors import ProtocolError
from strategies import codec_of
from targets.built import built
from targets.comparison import Comparison, ToolMissing
from targets.vectors.comparison import read
from targets.wireshark.captures import Chunk, serial
from targets.wireshark.dissecting import ABSENT, Item, dissected, events_of, joined, summary
from targets.wireshark.expected import expected_leaves

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
    lines = list(lines_of(edition))
    script = built("wireshark") / f"{edition}.lua"
    return compared(lines, codec_of(edition, "reference"), [script])


def compared(lines: list[Line], codec: Codec, scripts: list[Path] | None = None) -> Comparison:
    """Run lines through tshark, all at once."""
    return all_compared([(lines, codec)], scripts)


def all_compared(
    parts: list[tuple[list[Line], Codec]], scripts: list[Path] | None = None
) -> Comparison:
    """Run lines of several editions through tshark, all at once."""
    lines = [(line, codec) for own, codec in parts for line in own]
    editions = [codec.table.edition for _, codec in lines]
    chunks = [chunk for number, (line, _) in enumerate(lines) for chunk in _chunks(number, line)]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "vectors.pcapng"
        path.write_bytes(serial(chunks, editions))
        packets = dissected(path, " ".join(sorted(set(editions))), scripts=scripts)
    shown: dict[int, list[list[Item]]] = defaultdict(list)
    for chunk, items in zip(chunks, packets, strict=True):
        if chunk.direction == lines[chunk.line][0].direction:
            shown[chunk.line].append(items)
    fields, refused, differences = 0, 0, []
    for number, (line, codec) in enumerate(lines):
        validated = list(_check(line, codec, shown[number]))
        refused += line.name.startswith("malformed: ")
        fields += sum(check.is_field for check in validated)
        differences += [
            f"{line.name}: {check.difference}" for check in validated if check.difference
        ]
    return Comparison(len(lines), fields, differences, refused)


def _chunks(number: int, line: Line) -> Iterator[Chunk]:
    if line.text_request:
        yield Chunk(number, "request", line.text_request)
    for data in line.chunks:
        yield Chunk(number, line.direction, data)


def lines_of(edition: str) -> Iterator[Line]:
    """Return the spec's own vectors and the shared ones."""
    for vector in vectors.edition(edition).vectors:
        printed = vector.frame or vector.printed
        if printed is not None:
            yield Line(vector.name, vector.direction, [printed])
        elif vector.text is not None:
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


def _check(line: Line, codec: Codec, packets: list[list[Item]]) -> Iterator[Check]:
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
    format = codec.table.frame
    has_id = "frame.id" in item.own
    same = not has_id or int(item.own["frame.id"], 16) == frame.command
    same &= item.own.get("frame.address", "None") == str(format.address(frame.data))
    yield Check("" if same else f"head {item.own}")
    # A reply that was paired with a request is one of its command.
    paired = item.own["frame.command"] if "request_in" in item.own else None
    try:
        message = codec.decode("reply", frame.data, of=paired) if paired else frame.message
    except ProtocolError as error:
        fits = error.reason == "bad-value" and "bad_value" in item.experts
        yield Check("" if fits else f"{item.experts}, not {error}")
        return
    yield Check("" if item.experts == _experts(message) else f"{item.experts}")
    yield Check("" if has_id == format.has_id(message.direction) else f"id of {direction}")
    named = item.own["frame.command"], item.own["frame.direction"]
    same = named == (message.command.name, message.direction)
    yield Check("" if same else f"{named}, not {message.command.name}")
    wanted = list(expected_leaves(message, format.data(frame.data, message.direction)))
    yield Check("" if len(wanted) == len(item.leaves) else f"{len(item.leaves)} leaves")
    for leaf, right in zip(item.leaves, wanted):
        yield Check(right.difference(leaf), is_field=True)


def _experts(message: DecodedMessage) -> list[str]:
    has_status = bool(message.command.accepted) and message.direction == "reply"
    return ["failed"] if has_status and message.command.refusal(message.fields) else []
