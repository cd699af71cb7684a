"""construct parses and builds every type in every frame format as the codec does."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import pytest
from construct import ConstructError, EnumInteger, EnumIntegerString
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import random_specs
import vectors
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.loading import table_of
from cobotwire.protocol.table import Case, Direction, Field
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.targets.construct import render_construct
from random_editions import sensors
from trial_specs import FOOTED, HEAD, edition_of

NUMBERS = itertools.count()
TESTS = vectors.ROOT / "tests"
SPECS = [
    *(TESTS / "codegen" / "families" / f"{name}.yaml" for name in ("sensor", "mercury", "mybuddy")),
    *(TESTS / "protocols" / f"{name}.yaml" for name in ("feetech", "dynamixel", "ublox")),
]
FEW = settings(
    max_examples=4, phases=[Phase.reuse, Phase.generate], suppress_health_check=list(HealthCheck)
)
Declared = dict[tuple[str, str, int], Any]


class Pair:
    """The codec and the declarations of an edition."""

    def __init__(self, edition: Edition) -> None:
        self.codec: Codec = codecs.load(table_of(json.loads(edition_json(edition))), "reference")
        names: dict[str, Any] = {}
        [text] = render_construct([edition]).values()
        exec(compile(text, edition.name, "exec"), names)
        self.declared: Declared = names["MESSAGES"]

    def parsed(self, command: str, direction: str, data: bytes) -> Any:
        """Return what the first variant that accepts a frame reads; None if none does."""
        for (name, way, _), declaration in self.declared.items():
            if (name, way) == (command, direction):
                try:
                    return declaration, declaration.parse(data)
                except ConstructError:
                    continue
        return None

    def read(self, command: str, direction: Direction, data: bytes) -> DecodedMessage | None:
        """Return what the codec reads; None if it rejects the frame."""
        try:
            return self.codec.decode(direction, data, of=command)
        except ProtocolError:
            return None

    def agree(self, command: str, direction: Direction, data: bytes) -> None:
        """Check that both accept a frame, read the same values and build it again, or neither."""
        found = self.parsed(command, direction, data)
        message = self.read(command, direction, data)
        assert (found is None) == (message is None), (command, data.hex(" "), message)
        if found is None or message is None:
            return
        declaration, parsed = found
        given = {}
        for field, value in zip(message.variant.fields, message.values):
            case = message.variant.case(field, message.values)
            given[field.name] = as_built(field, case, value)
            same = repr(plain(parsed[field.name])) == repr(plain(given[field.name]))
            assert same, (command, field.name, parsed[field.name], value)
        if message.address is not None:
            assert parsed.frame_address == message.address
            given["frame_address"] = message.address
        # Constants are built without a value.
        for field in message.variant.fields:
            if field.const is not None:
                del given[field.name]
        assert declaration.build(given) == rebuilt(self.codec, message)


def rebuilt(codec: Codec, message: DecodedMessage) -> bytes:
    """Return the frame of a message: bits without a name are 0, for instance."""
    command = message.command
    index = command.variants(message.direction).index(message.variant)
    values, address = message.values, message.address
    return codec.encode(command.name, message.direction, values, variant=index, address=address)


def plain(value: Any) -> Any:
    """Return a value of construct or of the codec as numbers, texts, bytes and tuples."""
    if isinstance(value, EnumInteger | EnumIntegerString | bool):
        return int(value)
    if isinstance(value, dict):
        return sorted((name, plain(part)) for name, part in value.items() if name != "_io")
    return tuple(map(plain, value)) if isinstance(value, list | tuple) else value


def as_built(field: Field, case: Case, value: Any) -> Any:
    """Return a value as construct takes it: with the names of the parts."""
    names = [number.name for number in case.numbers[: field.each or None]]
    if not any(names):
        return list(value) if isinstance(value, tuple) else value
    return [dict(zip(names, part)) for part in value] if field.each else dict(zip(names, value))


def test_vectors_of_other_protocols_are_parsed_and_built() -> None:
    for path in SPECS:
        edition = build_edition(path, path.parent)
        pair = Pair(edition)
        for vector in edition.vectors:
            assert vector.frame is not None
            assert pair.parsed(vector.command, vector.direction, vector.frame) is not None
            for at in range(len(vector.frame)):
                broken = bytearray(vector.frame)
                broken[at] ^= 0x81
                pair.agree(vector.command, vector.direction, bytes(broken))
            pair.agree(vector.command, vector.direction, vector.frame)
            pair.agree(vector.command, vector.direction, vector.frame[:-1])
            pair.agree(vector.command, vector.direction, vector.frame + b"\0")


def test_vectors_of_shipped_editions_are_parsed_and_built() -> None:
    """Read a part of the vectors; two editions have tests of their own."""
    for edition in map(vectors.edition, vectors.further()):
        pair = Pair(edition)
        for vector in edition.vectors[::8]:
            if vector.frame is not None:
                assert pair.parsed(vector.command, vector.direction, vector.frame) is not None
                pair.agree(vector.command, vector.direction, vector.frame)


@FEW
@given(data=st.data())
def test_random_protocols_are_parsed_and_built(tmp_path: Path, data: st.DataObject) -> None:
    _, edition = data.draw(random_specs.specs(tmp_path, f"con{next(NUMBERS)}"))
    pair = Pair(edition)
    for vector in edition.vectors:
        assert vector.frame is not None
        pair.agree(vector.command, vector.direction, vector.frame)
        pair.agree(vector.command, vector.direction, data.draw(changed(pair, edition, vector)))


@FEW
@given(editions=st.lists(sensors("con"), min_size=5, max_size=5))
def test_random_frame_formats_are_parsed_and_built(editions: list[Edition]) -> None:
    for edition in editions:
        pair = Pair(edition)
        for vector in edition.vectors:
            assert vector.frame is not None
            assert pair.parsed(vector.command, vector.direction, vector.frame) is not None
            pair.agree(vector.command, vector.direction, vector.frame)
            broken = vector.frame[:-1] + bytes([vector.frame[-1] ^ 1])
            pair.agree(vector.command, vector.direction, broken)


def changed(pair: Pair, edition: Edition, vector: Any) -> st.SearchStrategy[bytes]:
    """Return frames whose data differ from a vector's in some bytes, with the right check."""
    format = pair.codec.table.frame
    id, address = format.read_id(vector.frame), format.address(vector.frame)
    data = format.data(vector.frame, vector.direction)
    places = st.lists(st.tuples(st.integers(0, max(len(data) - 1, 0)), st.integers(0, 255)))

    def change(pairs: list[tuple[int, int]]) -> bytes:
        new = bytearray(data)
        for at, byte in pairs:
            new[at : at + 1] = bytes([byte])
        return format.enclose(id, bytes(new[: len(data)]), address, vector.direction)

    return places.map(change)


REST_FIRST = """
types:
  wire: {byte: {bytes: 1, doc: A byte.}}
  quantities: {count: {wire: byte, range: [0, 9], doc: A count.}}
  bytes: {blob: {size: [0, 9], doc: Bytes.}}
commands:
  put:
    id: 1
    title: Put
    doc: Puts bytes.
    safety: setting
    request:
      - {name: rest, type: blob}
      - {name: size, type: count}
      - {name: data, type: blob, count: size}
"""


def test_field_to_the_end_before_a_count_is_refused(tmp_path: Path) -> None:
    edition, problems = edition_of(HEAD + "joints: 1\n" + FOOTED + REST_FIRST, tmp_path)
    assert problems == []
    with pytest.raises(SpecError, match="unsupported-type: construct cannot express rest of put"):
        render_construct([edition])
