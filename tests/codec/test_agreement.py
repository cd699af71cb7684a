"""The reference and the native codec agree on bytes, events, values, errors and offsets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies
from cobotwire.codec.interface import Codec, Listening, Noise
from cobotwire.protocol.errors import CobotwireError, UsageError
from cobotwire.protocol.table import Direction
from strategies import TABLES, codec_of

DIRECTIONS = st.sampled_from(["request", "reply"])
LISTENING = st.sampled_from(["request", "reply", "both"])
EACH_EDITION = pytest.mark.parametrize("edition", TABLES)


def _both(edition: str) -> tuple[Codec, Codec]:
    return codec_of(edition, "reference"), codec_of(edition, "native")


def _outcome(action: Callable[[], Any]) -> Any:
    """Return the result, or everything that a caller can observe of the error."""
    try:
        return action()
    except CobotwireError as error:
        # repr, since a NaN among the values is not equal to itself.
        return type(error), str(error), repr(vars(error))


def _same(edition: str, action: Callable[[Codec], Any]) -> None:
    reference, native = _both(edition)
    assert _outcome(lambda: action(reference)) == _outcome(lambda: action(native))


@EACH_EDITION
@given(data=st.data())
def test_legal_message_survives_encode_and_decode(edition: str, data: st.DataObject) -> None:
    variant, values = data.draw(strategies.messages(TABLES[edition]))
    for codec in _both(edition):
        frame = strategies.frame_of(codec, variant, values)
        read = codec.decode(variant.direction, frame, of=variant.command.name)
        assert read.command is variant.command
        assert read.variant is variant.variant
        assert read.values == values


@EACH_EDITION
@given(data=st.data(), chosen=st.booleans())
def test_both_codecs_encode_the_same_bytes(edition: str, data: st.DataObject, chosen: bool) -> None:
    variant, values = data.draw(strategies.messages(TABLES[edition]))
    index = variant.number if chosen else None
    _same(
        edition,
        lambda codec: codec.encode(variant.command.name, variant.direction, values, variant=index),
    )


@EACH_EDITION
@given(data=st.data())
def test_both_codecs_reject_the_same_arguments_with_the_same_message(
    edition: str, data: st.DataObject
) -> None:
    arguments = data.draw(strategies.any_arguments(TABLES[edition]))
    _same(edition, lambda codec: codec.encode(*arguments))


@EACH_EDITION
@given(DIRECTIONS, st.data())
def test_both_codecs_decode_a_frame_alike_or_reject_it_at_the_same_byte(
    edition: str, direction: Direction, data: st.DataObject
) -> None:
    table = TABLES[edition]
    pieces = st.one_of(strategies.real_frames(table), strategies.near_frames(table), st.binary())
    piece = data.draw(pieces)
    of = data.draw(st.none() | st.sampled_from([command.name for command in table.commands]))
    _same(edition, lambda codec: codec.decode(direction, piece, of=of))


@EACH_EDITION
@given(LISTENING, st.booleans(), st.data())
def test_both_framers_return_the_same_events(
    edition: str, listening: Listening, accept_unknown: bool, data: st.DataObject
) -> None:
    chunks = data.draw(strategies.chunked(data.draw(strategies.streams(TABLES[edition]))))
    flushes = data.draw(st.lists(st.booleans(), min_size=len(chunks), max_size=len(chunks)))
    framers = [codec.framer(listening, accept_unknown=accept_unknown) for codec in _both(edition)]
    for chunk, flush in zip(chunks, flushes):
        # Flushing in the middle is what a client does at a deadline.
        events = [f.feed(chunk) + (f.flush() if flush else []) for f in framers]
        assert events[0] == events[1]
        assert framers[0].pending == framers[1].pending
    assert framers[0].flush() == framers[1].flush()


@EACH_EDITION
@pytest.mark.parametrize("name", ["send_angels", "", "SEND_ANGLES"])
def test_unknown_command_raises_the_same_error_in_both_codecs(edition: str, name: str) -> None:
    _same(edition, lambda codec: codec.encode(name, "request", ()))


def test_feed_accepts_any_bytes_like_object() -> None:
    frame = bytes.fromhex("FEFE0220FA")
    for kind in (bytes, bytearray, memoryview):
        for codec in _both("mycobot"):
            [event] = codec.framer("request").feed(kind(frame))
            assert not isinstance(event, Noise)
            assert event.data == frame


def test_wrong_direction_is_named_in_the_error(codec: Codec) -> None:
    sideways: Any = "sideways"
    actions: list[Callable[[], Any]] = [
        lambda: codec.encode("stop", sideways, ()),
        lambda: codec.decode(sideways, b""),
        lambda: codec.framer(sideways),
    ]
    for action in actions:
        with pytest.raises(UsageError, match="direction is 'sideways'; allowed: request or"):
            action()
