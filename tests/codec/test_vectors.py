"""Both codecs encode and decode the vectors of every edition's spec."""

from __future__ import annotations

import pytest

import vectors
from cobotwire.codec.interface import Codec, Frame
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction
from cobotwire_codegen.model import Vector
from strategies import TABLES, codec_of


def _named(found: list[tuple[str, Vector]]) -> pytest.MarkDecorator:
    names = [f"{edition}-{vector.name}" for edition, vector in found]
    return pytest.mark.parametrize(("edition", "vector"), found, ids=names)


FRAMED = _named(vectors.framed())
LIMITED = _named(vectors.limited())
REJECTED = _named(vectors.rejected())


def test_every_edition_has_vectors() -> None:
    assert {edition for edition, _ in vectors.framed()} == set(TABLES)
    assert vectors.further()
    assert all(vectors.edition(name).vectors for name in vectors.further())


@pytest.mark.parametrize("edition", vectors.further())
def test_vectors_of_a_further_edition_hold(codec: Codec, edition: str) -> None:
    for vector in vectors.edition(edition).vectors:
        if vector.accepted or vector.refused:
            test_codec_accepts_and_refuses_the_stated_values(codec, edition, vector)
        if vector.frame is not None:
            test_stated_values_encode_to_the_frame(codec, edition, vector)
            test_frame_decodes_to_its_stated_values(codec, edition, vector)
            test_framer_finds_the_frame_after_noise(codec, edition, vector)


def test_all_examples_of_the_document_are_vectors() -> None:
    numbers = [vector.example for vector in vectors.edition().vectors if vector.example]
    assert numbers == list(range(1, 89))


@FRAMED
def test_stated_values_encode_to_the_frame(codec: Codec, edition: str, vector: Vector) -> None:
    codec = codec_of(edition, codec.name)
    values = tuple(vectors.fields(edition, vector).values())
    assert vector.frame is not None
    address = codec.table.frame.address(vector.frame)
    frame = codec.encode(vector.command, vector.direction, values, address=address)
    assert frame == vector.frame


@LIMITED
def test_codec_accepts_and_refuses_the_stated_values(
    codec: Codec, edition: str, vector: Vector
) -> None:
    codec = codec_of(edition, codec.name)
    for fields, legal in vectors.limits(edition, vector):
        try:
            codec.encode(vector.command, vector.direction, tuple(fields.values()))
        except UsageError:
            assert not legal, fields
        else:
            assert legal, fields


@FRAMED
def test_frame_decodes_to_its_stated_values(codec: Codec, edition: str, vector: Vector) -> None:
    assert vector.frame is not None
    codec = codec_of(edition, codec.name)
    message = codec.decode(vector.direction, vector.frame, of=vector.command)
    assert message.command.name == vector.command
    assert message.fields == vectors.fields(edition, vector)


@FRAMED
def test_frame_decodes_without_a_name_as_the_first_command_that_allows_it(
    codec: Codec, edition: str, vector: Vector
) -> None:
    frame = vector.frame
    assert frame is not None
    codec = codec_of(edition, codec.name)

    def allowed(call: str) -> bool:
        try:
            codec.decode(vector.direction, frame, of=call)
        except ProtocolError:
            return False
        return True

    id = codec.table.frame.read_id(frame)
    of_this_id = [command.name for command in codec.table.commands if command.id == id]
    calls = [call for call in of_this_id if allowed(call)]
    assert vector.command in calls
    assert codec.decode(vector.direction, frame).command.name == calls[0]


@FRAMED
def test_framer_finds_the_frame_after_noise(codec: Codec, edition: str, vector: Vector) -> None:
    assert vector.frame is not None
    codec = codec_of(edition, codec.name)
    framer = codec.framer(vector.direction)
    found = [e for e in framer.feed(b"\xff\xfe\xfe" + vector.frame) if isinstance(e, Frame)]
    assert found == [Frame(3, vector.frame, codec.table.frame.read_id(vector.frame))]


def test_five_examples_have_an_illegal_length_in_both_directions(codec: Codec) -> None:
    def legal(printed: bytes, direction: Direction) -> bool:
        try:
            codec.decode(direction, printed)
        except ProtocolError:
            return False
        return True

    illegal = [
        vector.example
        for vector in vectors.edition().vectors
        if vector.printed
        and not (legal(vector.printed, "request") or legal(vector.printed, "reply"))
    ]
    assert illegal == [26, 32, 37, 74, 75]
    # Example 57 prints a reply in place of a request, so it is rejected as a request, too.
    rejected = [vector.example for edition, vector in vectors.rejected() if edition == "mycobot"]
    assert rejected == [26, 32, 37, 57, 74, 75]


@REJECTED
def test_illegal_length_is_rejected_with_its_reason(
    codec: Codec, edition: str, vector: Vector
) -> None:
    assert vector.printed is not None
    assert vector.rejected is not None
    with pytest.raises(ProtocolError, match="LEN") as caught:
        codec_of(edition, codec.name).decode(vector.direction, vector.printed)
    assert (caught.value.reason, caught.value.offset) == vector.rejected
    assert caught.value.data == vector.printed


@pytest.mark.parametrize("edition", TABLES)
def test_older_variant_of_a_reply_decodes_without_the_joint(codec: Codec, edition: str) -> None:
    codec = codec_of(edition, codec.name)
    full = codec.decode("reply", bytes.fromhex("FEFE04500101FA"))
    short = codec.decode("reply", bytes.fromhex("FEFE035001FA"))
    assert full.fields == {"joint": 1, "enabled": 1}
    assert short.fields == {"enabled": 1}


@pytest.mark.parametrize("edition", TABLES)
def test_degrees_are_rounded_to_the_nearest_raw_value(codec: Codec, edition: str) -> None:
    frame = codec_of(edition, codec.name).encode("send_angle", "request", (1, 0.29, 20))
    assert frame == bytes.fromhex("FEFE06210100 1D14FA"), "0.29 degrees is 29 steps, not 28"
