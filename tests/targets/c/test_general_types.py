"""C code for floats, bits, bytes, texts and lists, in any frame, agrees with our codec."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from targets.c.agreement import Sides, compare_messages, compare_streams
from targets.c.compiled import missing
from targets.c.peer import Read
from targets.c.specs import SPECS, edition_of
from targets.expected import frames_with_odd_texts

pytestmark = pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))
QUICK = settings(max_examples=60)


@pytest.fixture(scope="module", params=sorted(SPECS))
def sides(request: pytest.FixtureRequest) -> Iterator[Sides]:
    found = Sides(edition_of(SPECS[request.param]))
    yield found
    found.peer.close()


def test_vectors_of_the_spec_are_read_and_built_as_in_codec(sides: Sides) -> None:
    for vector in sides.edition.vectors:
        assert vector.frame is not None
        found = sides.peer.read(vector.direction, vector.frame)
        assert isinstance(found, Read)
        assert found == sides.ours.read(vector.direction, vector.frame)
        address = sides.address(vector.frame)
        assert sides.peer.encode(found.message, found.raw_values, address) == vector.frame


@QUICK
@given(data=st.data())
def test_message_is_read_and_built_as_in_codec(sides: Sides, data: st.DataObject) -> None:
    compare_messages(sides, data)


@QUICK
@given(data=st.data())
def test_stream_is_framed_as_in_codec(sides: Sides, data: st.DataObject) -> None:
    compare_streams(sides, data)


def test_text_is_utf_8_as_in_codec() -> None:
    sides = Sides(edition_of(SPECS["sensor"]))
    for frame in frames_with_odd_texts(sides.ours.codec):
        found = sides.ours.read_in_c(sides.peer.read("reply", frame))
        assert found == sides.ours.read("reply", frame)
    sides.peer.close()


def test_list_with_too_many_elements_is_rejected() -> None:
    sides = Sides(edition_of(SPECS["sensor"]))
    [number] = [
        index
        for index, message in enumerate(sides.ours.messages)
        if message.symbol == "set_temperatures_request"
    ]
    assert sides.peer.encode(number, [41, *[20] * 41]) == ("bad-value", number, 0, 0, 0)
    enough = sides.peer.encode(number, [40, *[20] * 40])
    assert isinstance(enough, bytes)
    assert len(enough) == 45
    sides.peer.close()
