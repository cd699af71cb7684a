"""Decoding a framer's frame skips the second check and gives the same result."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, DecodedMessage, Frame, Listening
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction
from strategies import TABLES, codec_of, streams

NAMES: tuple[codecs.CodecName, ...] = ("reference", "native")
LISTENING: tuple[Listening, ...] = ("request", "reply", "both")
DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


def _outcome(decode: Callable[[], DecodedMessage]) -> Any:
    """Return the message, or everything that an error carries."""
    try:
        return decode()
    except ProtocolError as error:
        return error.reason, error.offset, error.data, str(error)


def _frames(codec: Codec, listening: Listening, unknown: bool, data: bytes) -> list[Frame]:
    framer = codec.framer(listening, accept_unknown=unknown)
    return [event for event in [*framer.feed(data), *framer.flush()] if isinstance(event, Frame)]


@pytest.mark.parametrize("edition", TABLES)
@given(data=st.data(), listening=st.sampled_from(LISTENING), unknown=st.booleans())
def test_decoded_frame_equals_its_decoded_bytes(
    edition: str, data: st.DataObject, listening: Listening, unknown: bool
) -> None:
    table = TABLES[edition]
    stream = data.draw(streams(table))
    commands = [None, *data.draw(st.lists(st.sampled_from(table.commands), max_size=3))]
    found = []
    for name in NAMES:
        codec = codec_of(edition, name)
        frames = _frames(codec, listening, unknown, stream)
        found.append([_outcome(frame.decode) for frame in frames])
        for frame in frames:
            same_id = [command for command in table.commands if command.id == frame.command]
            for command in [*commands, *same_id]:
                of = None if command is None else command.name
                for way in DIRECTIONS:
                    decoded_again = _outcome(partial(codec.decode, way, frame.data, of=of))
                    assert _outcome(partial(frame.decode, way, of=of)) == decoded_again
    assert found[0] == found[1]


@pytest.mark.parametrize("name", NAMES)
def test_frame_decoded_in_its_only_direction_is_its_message(name: codecs.CodecName) -> None:
    codec = codec_of("mycobot", name)
    data = codec.encode("get_encoder", "request", (1,))
    [frame] = _frames(codec, "request", False, data)
    assert frame.decode() == frame.decode("request", of="get_encoder") == frame.message
    with pytest.raises(ProtocolError, match="has no request with id"):
        frame.decode(of="get_angles")


@pytest.mark.parametrize("name", NAMES)
def test_frame_is_not_decoded_as_an_unknown_command_or_direction(name: codecs.CodecName) -> None:
    codec = codec_of("mycobot", name)
    [frame] = _frames(codec, "request", False, codec.encode("power_on", "request", ()))
    with pytest.raises(UsageError, match="did you mean power_on"):
        frame.decode(of="power_onn")
    wrong: Any = "sideways"
    with pytest.raises(UsageError, match="direction is 'sideways'; allowed: request or reply"):
        frame.decode(wrong)


def test_frame_not_cut_by_a_framer_is_not_decoded() -> None:
    with pytest.raises(UsageError, match="did not come from a framer"):
        Frame(0, b"", 0x20).decode()
