"""The document's frames, and those that it forgot, on both codecs."""

from __future__ import annotations

import pytest

import vectors
from cobotwire.codec.interface import Codec, Frame
from cobotwire.errors import ProtocolError
from cobotwire.table import Direction
from cobotwire_codegen.model import Vector


def _name(vector: Vector) -> str:
    return vector.name


def test_all_of_the_documents_examples_are_there() -> None:
    numbers = [vector.example for vector in vectors.edition().vectors if vector.example]
    assert numbers == list(range(1, 89))


@pytest.mark.parametrize("vector", vectors.framed(), ids=_name)
def test_stated_values_build_the_frame(codec: Codec, vector: Vector) -> None:
    assert codec.encode(vector.command, vector.direction, vectors.values(vector)) == vector.frame


@pytest.mark.parametrize("vector", vectors.framed(), ids=_name)
def test_the_frame_decodes_to_its_stated_values(codec: Codec, vector: Vector) -> None:
    assert vector.frame is not None
    message = codec.decode(vector.direction, vector.frame)
    assert (message.command.name, message.values) == (vector.command, vectors.values(vector))


@pytest.mark.parametrize("vector", vectors.framed(), ids=_name)
def test_the_framer_finds_the_frame_behind_noise(codec: Codec, vector: Vector) -> None:
    assert vector.frame is not None
    framer = codec.framer(vector.direction)
    found = [e for e in framer.feed(b"\xff\xfe\xfe" + vector.frame) if isinstance(e, Frame)]
    assert found == [Frame(3, vector.frame, vector.frame[3])]


def test_five_examples_have_an_illegal_length_whichever_way_they_go(codec: Codec) -> None:
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
    # Example 57 prints a reply where a request should stand: refused as a request, too.
    assert [vector.example for vector in vectors.refused()] == [26, 32, 37, 57, 74, 75]


@pytest.mark.parametrize("vector", vectors.refused(), ids=_name)
def test_an_illegal_length_is_refused_with_its_reason(codec: Codec, vector: Vector) -> None:
    assert vector.printed is not None
    assert vector.refused is not None
    with pytest.raises(ProtocolError, match="LEN") as caught:
        codec.decode(vector.direction, vector.printed)
    assert (caught.value.reason, caught.value.offset) == vector.refused
    assert caught.value.data == vector.printed


def test_the_older_form_of_a_reply_says_that_its_echo_is_missing(codec: Codec) -> None:
    full = codec.decode("reply", bytes.fromhex("FEFE04500101FA"))
    short = codec.decode("reply", bytes.fromhex("FEFE035001FA"))
    assert full.fields == {"joint": 1, "enabled": 1}
    assert short.fields == {"enabled": 1}


def test_degrees_are_rounded_to_the_nearest_step(codec: Codec) -> None:
    frame = codec.encode("send_angle", "request", (1, 0.29, 20))
    assert frame == bytes.fromhex("FEFE06210100 1D14FA"), "0.29 degrees is 29 steps, not 28"
