"""Frames in any format that a spec can state, with any check and address, in both codecs.

``tests/found/frames.txt`` has damaged frames with a CRC, or with an address and a sum.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

import random_formats
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from cobotwire_codegen.wire import build_frame
from json_tables import sample
from random_formats import stated_frame
from strategies import CODECS, DIRECTIONS
from targets.expected import codec_of_edition

CRC, SUM = sample("crc"), sample("sum")


@pytest.fixture(params=CODECS)
def load(request: pytest.FixtureRequest) -> Callable[[Table], Codec]:
    """Return a function that makes codecs of one kind; each test runs with both kinds."""
    return lambda table: codecs.load(table, request.param)


def test_first_address_is_sent_unless_another_is_given(
    load: Callable[[Table], Codec],
) -> None:
    codec = load(SUM)
    assert codec.encode("power_on", "request", ())[2] == 1
    assert codec.encode("power_on", "request", (), address=3)[2] == 3
    with pytest.raises(UsageError, match="address is 4; allowed: 1, 0, 2, 3"):
        codec.encode("power_on", "request", ("the address is checked before any value",), address=4)
    with pytest.raises(UsageError, match="address is 0; allowed: None"):
        load(CRC).encode("get_angles", "request", (), address=0)


@given(st.data())
def test_every_format_that_a_spec_can_state_is_sent_and_read_as_stated(data: st.DataObject) -> None:
    record, edition = data.draw(random_formats.formats())
    id = data.draw(st.integers(0, 256**edition.frame.command_number.width - 1))
    edition = random_formats.in_format(record, id)
    address = data.draw(st.sampled_from(edition.frame.address_values or (None,)))
    content = data.draw(st.binary(min_size=2, max_size=20))
    values: dict[str, object] = {"data": content.hex(" ")}
    for direction in DIRECTIONS:
        frame = stated_frame(record, id, content, address or 0, reply=direction == "reply")
        assert build_frame(edition.frame, edition.commands[0], direction, values, address) == frame
        for name in CODECS:
            codec = codec_of_edition(edition, name)
            assert (
                codec.encode(
                    "send", direction, (content,), variant=len(content) - 2, address=address
                )
                == frame
            )
            assert codec.decode(direction, frame).values == (content,)
            [event] = codec.framer(direction).feed(frame)
            assert isinstance(event, Frame)
            assert event.data == frame
