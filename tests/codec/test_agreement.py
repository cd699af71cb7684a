"""The reference and the native codec agree on bytes, events, values, columns, errors and offsets.

The tables are those of editions, of the maker's other formats, and random ones. Values are compared
as text, since 0.0 equals -0.0, and a NaN does not equal itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import random_tables
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame, Listening, Noise
from cobotwire.protocol.errors import CobotwireError, ProtocolError, UsageError
from cobotwire.protocol.table import Direction, Table
from codec.results import everything
from strategies import TABLES, codec_of

LISTENING = st.sampled_from(["request", "reply", "both"])
# Whole frames, the two parts of one, two frames at once, an unknown id, and noise.
PIECES = [
    bytes.fromhex(text)
    for text in (
        *("FE FE 03 12 01 FA", "FE FE 04 3B 00 01 FA", "FE FE 04", "3B 00 01 FA"),
        *("FE FE 03 12 01 FA FE FE 03 12 00 FA", "FE FE 03 99 01 FA", "FE FE 03 12 01 FA FE", "00"),
    )
]


def _outcome(action: Callable[[], Any]) -> Any:
    """Return the result, or everything that a caller can see of the error."""
    try:
        return action()
    except CobotwireError as error:
        return type(error), str(error), repr(vars(error))


def _same(table: Table, action: Callable[[Codec], Any]) -> None:
    reference, native = codecs.load(table, "reference"), codecs.load(table, "native")
    assert _outcome(lambda: action(reference)) == _outcome(lambda: action(native))


@given(random_tables.any_tables(), LISTENING, st.booleans(), st.data())
def test_both_framers_return_the_same_events_and_keep_the_same_bytes(
    table: Table, listening: Listening, accept_unknown: bool, data: st.DataObject
) -> None:
    chunks = data.draw(strategies.chunked(data.draw(random_tables.any_streams(table))))
    flushes = data.draw(st.lists(st.booleans(), min_size=len(chunks), max_size=len(chunks)))

    def events(codec: Codec) -> list[Any]:
        framer = codec.framer(listening, accept_unknown=accept_unknown)
        found: list[Any] = []
        for chunk, flush in zip(chunks, flushes):
            # Flushing in the middle is what a client does at a deadline.
            found += [framer.feed(chunk), framer.pending, framer.flush() if flush else []]
        return [*found, framer.flush(), framer.counters]

    _same(table, events)


@given(st.lists(st.sampled_from(PIECES), max_size=8), st.booleans())
def test_chunk_that_is_one_frame_has_the_same_events_and_counts(
    chunks: list[bytes], accept_unknown: bool
) -> None:
    """The native framer has a fast path for such a chunk."""

    def events(codec: Codec) -> list[Any]:
        framer = codec.framer("reply", accept_unknown=accept_unknown)
        found = [[framer.feed(chunk), framer.pending, framer.counters] for chunk in chunks]
        return [*found, framer.flush(), framer.counters]

    _same(TABLES["mycobot"], events)


def _readings(codec: Codec, frame: Frame, names: list[str]) -> Iterator[Any]:
    """Yield the results of decoding a framer's frame in each direction and as each command."""
    yield _outcome(lambda: repr(frame.message)), _outcome(lambda: repr(frame.values))
    for name in [None, *names]:
        yield _outcome(lambda: repr(frame.decode(of=name)))  # noqa: B023  (called at once)
        for direction in strategies.DIRECTIONS:
            read = _outcome(lambda: repr(frame.decode(direction, of=name)))  # noqa: B023
            # Decoding a framer's frame skips the second check, with the same result.
            again = _outcome(lambda: repr(codec.decode(direction, frame.data, of=name)))  # noqa: B023
            assert read == again
            yield read


@given(random_tables.any_tables(), LISTENING, st.booleans(), st.data())
def test_frames_are_read_alike_in_every_direction_and_as_every_command(
    table: Table, listening: Listening, accept_unknown: bool, data: st.DataObject
) -> None:
    stream = data.draw(random_tables.any_streams(table))
    some = data.draw(st.lists(st.sampled_from([c.name for c in table.commands]), max_size=3))
    same_id = [(command.id, command.name) for command in table.commands]

    def readings(codec: Codec) -> list[Any]:
        framer = codec.framer(listening, accept_unknown=accept_unknown)
        frames = [e for e in framer.feed(stream) + framer.flush() if isinstance(e, Frame)]
        return [
            list(_readings(codec, f, [*some, *(name for id, name in same_id if id == f.command)]))
            for f in frames
        ]

    _same(table, readings)


@given(random_tables.any_tables(), st.data())
def test_bytes_are_decoded_alike_or_rejected_at_the_same_byte(
    table: Table, data: st.DataObject
) -> None:
    piece = bytearray(data.draw(random_tables.any_streams(table) | st.binary()))
    for at in data.draw(st.lists(st.integers(0, 40), max_size=2)):
        piece[at : at + 1] = data.draw(st.binary(max_size=1))
    of = data.draw(st.none() | st.sampled_from([command.name for command in table.commands]))
    direction = data.draw(st.sampled_from(strategies.DIRECTIONS))
    _same(table, lambda codec: repr(codec.decode(direction, bytes(piece), of=of)))


@given(random_tables.any_tables(), st.data())
def test_values_are_encoded_alike_or_rejected_with_the_same_message(
    table: Table, data: st.DataObject
) -> None:
    command = data.draw(st.sampled_from(table.commands))
    directions = strategies.DIRECTIONS if command.reply else strategies.DIRECTIONS[:1]
    direction: Direction = data.draw(st.sampled_from(directions))
    variant = data.draw(st.sampled_from(command.variants(direction)))
    values = data.draw(random_tables.values(variant))
    values += data.draw(st.sampled_from([(), (), (), (5,)]))
    index = data.draw(st.none() | st.none() | st.integers(-1, 2))
    address = data.draw(st.none() | st.none() | st.integers(-1, 4))
    _same(
        table,
        lambda codec: codec.encode(command.name, direction, values, variant=index, address=address),
    )


@pytest.mark.parametrize("edition", TABLES)
@given(data=st.data())
def test_legal_message_survives_encode_and_decode(edition: str, data: st.DataObject) -> None:
    variant, values = data.draw(strategies.messages(TABLES[edition]))
    _same(
        TABLES[edition],
        lambda codec: codec.encode(variant.command.name, variant.direction, values),
    )
    for name in strategies.CODECS:
        codec = codec_of(edition, name)
        frame = strategies.frame_of(codec, variant, values)
        read = codec.decode(variant.direction, frame, of=variant.command.name)
        assert read.command is variant.command
        assert read.variant is variant.variant
        assert read.values == values


@given(random_tables.any_tables(), LISTENING, st.booleans(), st.data())
def test_columns_and_scans_are_the_same_in_the_same_order(
    table: Table, listening: Listening, flag: bool, data: st.DataObject
) -> None:
    stream = data.draw(random_tables.any_streams(table))
    _same(table, lambda codec: everything(codec.decode_columns(stream, listening, raw=flag)))
    _same(table, lambda codec: everything(codec.scan(stream, listening, accept_unknown=flag)))


@pytest.mark.parametrize("name", ["send_angels", "", "SEND_ANGLES"])
def test_unknown_command_raises_the_same_error_in_both_codecs(name: str) -> None:
    for table in TABLES.values():
        _same(table, lambda codec: codec.encode(name, "request", ()))


def test_feed_accepts_any_bytes_like_object(codec: Codec) -> None:
    frame = bytes.fromhex("FEFE0220FA")
    for kind in (bytes, bytearray, memoryview):
        [event] = codec.framer("request").feed(kind(frame))
        assert not isinstance(event, Noise)
        assert event.data == frame


def test_wrong_direction_or_command_is_named_in_the_error(codec: Codec) -> None:
    sideways: Any = "sideways"
    [frame] = codec.framer("request").feed(codec.encode("power_on", "request", ()))
    assert isinstance(frame, Frame)
    actions: list[Callable[[], Any]] = [
        lambda: codec.encode("stop", sideways, ()),
        lambda: codec.decode(sideways, b""),
        lambda: codec.framer(sideways),
        lambda: frame.decode(sideways),
    ]
    for action in actions:
        with pytest.raises(UsageError, match="direction is 'sideways'; allowed: request or"):
            action()
    with pytest.raises(UsageError, match="did you mean power_on"):
        frame.decode(of="power_onn")
    with pytest.raises(ProtocolError, match="has no request with id"):
        frame.decode(of="get_angles")


def test_frame_not_cut_by_a_framer_is_not_decoded() -> None:
    with pytest.raises(UsageError, match="did not come from a framer"):
        Frame(0, b"", 0x20).decode()
