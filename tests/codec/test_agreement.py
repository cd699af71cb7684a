"""Reference and native agree: bytes, events, values, errors and offsets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.errors import CobotwireError, UsageError
from cobotwire.table import Direction

REFERENCE = codecs.load(TABLE, "reference")
NATIVE = codecs.load(TABLE, "native")
DIRECTIONS = st.sampled_from(["request", "reply"])
LISTENING = st.sampled_from(["request", "reply", "both"])


def _outcome(action: Callable[[], Any]) -> Any:
    """The result, or everything that a caller can see of the error."""
    try:
        return action()
    except CobotwireError as error:
        # repr, since a NaN among the values is not equal to itself.
        return type(error), str(error), repr(vars(error))


def _same(action: Callable[[Codec], Any]) -> None:
    assert _outcome(lambda: action(REFERENCE)) == _outcome(lambda: action(NATIVE))


@given(strategies.messages())
def test_a_legal_message_survives_the_round_trip(message: tuple[strategies.Form, Any]) -> None:
    form, values = message
    for codec in (REFERENCE, NATIVE):
        frame = codec.encode(form.command.name, form.direction, values)
        read = codec.decode(form.direction, frame)
        assert read.command is form.command
        assert read.layout is form.layout
        assert read.values == values


@given(strategies.messages())
def test_both_build_the_same_bytes(message: tuple[strategies.Form, Any]) -> None:
    form, values = message
    _same(lambda codec: codec.encode(form.command.name, form.direction, values))


@given(strategies.any_arguments())
def test_both_refuse_the_same_arguments_in_the_same_words(
    arguments: tuple[str, Direction, tuple[Any, ...]],
) -> None:
    _same(lambda codec: codec.encode(*arguments))


@given(DIRECTIONS, st.one_of(strategies.real_frames(), strategies.near_frames(), st.binary()))
def test_both_read_the_same_frame_or_refuse_it_at_the_same_byte(
    direction: Direction, data: bytes
) -> None:
    _same(lambda codec: codec.decode(direction, data))


@given(LISTENING, st.booleans(), st.data())
def test_both_cut_the_same_events(
    listening: Listening, accept_unknown: bool, data: st.DataObject
) -> None:
    chunks = data.draw(strategies.chunked(data.draw(strategies.streams())))
    flushes = data.draw(st.lists(st.booleans(), min_size=len(chunks), max_size=len(chunks)))
    framers = [
        codec.framer(listening, accept_unknown=accept_unknown) for codec in (REFERENCE, NATIVE)
    ]
    for chunk, flush in zip(chunks, flushes):
        # Flushing in the middle is what a driver does at a deadline.
        events = [f.feed(chunk) + (f.flush() if flush else []) for f in framers]
        assert events[0] == events[1]
        assert framers[0].pending == framers[1].pending
    assert framers[0].flush() == framers[1].flush()


def test_unhandled_kinds_of_input_are_the_same_error() -> None:
    for name in ("send_angels", "", "SEND_ANGLES"):
        _same(lambda codec, name=name: codec.encode(name, "request", ()))  # type: ignore[misc]


def test_feeding_takes_any_bytes_like() -> None:
    frame = bytes.fromhex("FEFE0220FA")
    for kind in (bytes, bytearray, memoryview):
        for codec in (REFERENCE, NATIVE):
            [event] = codec.framer("request").feed(kind(frame))
            assert not isinstance(event, Noise)
            assert event.data == frame


def test_a_word_that_is_no_direction_is_named(codec: Codec) -> None:
    sideways: Any = "sideways"
    actions: list[Callable[[], Any]] = [
        lambda: codec.encode("stop", sideways, ()),
        lambda: codec.decode(sideways, b""),
        lambda: codec.framer(sideways),
    ]
    for action in actions:
        with pytest.raises(UsageError, match="direction is 'sideways'; allowed: request or"):
            action()
