"""The maker's other frame formats (CRC, or address and sum), and variants distinguished by value.

No edition uses them yet, so this module makes the tables: B and C follow the maker's other robots,
and ALIKE has variants that share an id and a size.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.protocol.errors import CobotwireError, ProtocolError, UsageError
from cobotwire.protocol.frame_format import crc16_modbus
from cobotwire.protocol.table import (
    Case,
    Command,
    Direction,
    Field,
    FrameFormat,
    Number,
    Table,
    Variant,
)

HEADER = b"\xfe\xfe"


def _byte(name: str, minimum: int = 0, maximum: int = 255, *choices: int) -> Field:
    number = Number("", 1, "big", 255, 1, 1, minimum, maximum, "")
    return Field(name, "number", (Case((), (number,)),), "", choices=choices)


def _words(name: str, count: int, width: int, divide: int) -> Field:
    top = 256**width // 2
    number = Number("", width, "big", top - 1, 1, divide, -top, top - 1, "")
    return Field(name, "number", (Case((), (number,) * count),), "", many=True)


def _command(id: int, name: str, request: tuple[Variant, ...], *reply: Variant) -> Command:
    return Command(id, name, "", "", "test", "query", 100, request, reply)


NOTHING = (Variant(()),)
STATUS = Variant((_byte("status"),))
SET = Variant((_byte("servo"), _byte("status")))
B = Table(
    "mercury",
    "Variant B",
    6,
    115200,
    FrameFormat(HEADER, b"", 40, "crc16-modbus"),
    (
        _command(0x58, "set_free_mode", (STATUS,), STATUS, SET),
        _command(0x6E, "get_robot_status", NOTHING, STATUS),
        _command(0x4D, "set_break", (STATUS,), SET),
        _command(0x4C, "set_speed", (SET,), Variant((_byte("mode"), _words("speed", 1, 2, 1)))),
        _command(0x5B, "motion_end", NOTHING, STATUS),
        _command(0x20, "get_angles", NOTHING, Variant((_words("angles", 6, 4, 1000),))),
        _command(0x22, "send_angles", (Variant((_words("angles", 6, 2, 100), _byte("speed"))),)),
    ),
)
C = Table(
    "mybuddy",
    "Variant C",
    6,
    115200,
    FrameFormat(HEADER, b"", 16, "sum", (1, 0, 2, 3)),
    (
        _command(0x10, "power_on", NOTHING),
        _command(0x12, "is_power_on", NOTHING, STATUS),
        _command(0x20, "get_angles", NOTHING, Variant((_words("angles", 6, 2, 100),))),
        _command(0x22, "send_angles", (Variant((_words("angles", 6, 2, 100), _byte("speed"))),)),
    ),
)
# Commands with the same id and size, distinguished by a constant, by bounds, or not at all.
ALIKE = Table(
    "alike",
    "Messages that share an id and a size",
    6,
    115200,
    FrameFormat(HEADER, b"\xfa", 16),
    (
        _command(0x60, "set_left", (Variant((_byte("side", 0, 255, 1), _byte("value", 0, 99))),)),
        _command(0x60, "set_right", (Variant((_byte("side", 0, 255, 2), _byte("value", 0, 99))),)),
        _command(0x61, "jog", (Variant((_byte("low", 0, 9),)), Variant((_byte("high", 20, 29),)))),
        _command(0x61, "jog_too", (Variant((_byte("any"),)),), STATUS),
    ),
)
REAL = {
    "FE FE 04 58 01 FD 87": ("request", "set_free_mode", (1,)),
    "FE FE 05 58 FF 01 3E 3D": ("reply", "set_free_mode", (255, 1)),
    "FE FE 03 6E 20 D1": ("request", "get_robot_status", ()),
    "FE FE 04 6E 00 9D 51": ("reply", "get_robot_status", (0,)),
    "FE FE 05 4D FF 01 FA 2C": ("reply", "set_break", (255, 1)),
    "FE FE 06 4C 03 F9 0C D4 3D": ("reply", "set_speed", (3, (-1780,))),
    "FE FE 04 5B 01 0D 87": ("reply", "motion_end", (1,)),
}
OWN = {
    "FE FE 01 02 10 10": ("request", "power_on", (), 1),
    "FE FE 00 02 20 20": ("request", "get_angles", (), 0),
    "FE FE 03 03 12 FF 11": ("reply", "is_power_on", (255,), 3),
    "FE FE 02 0E 20 00 64 FF 9C 00 00 00 00 00 00 23 28 6A": (
        "reply",
        "get_angles",
        ((1.0, -1.0, 0.0, 0.0, 0.0, 90.0),),
        2,
    ),
}
VARIANTS = pytest.mark.parametrize("table", [B, C], ids=["B", "C"])
NAMES: list[codecs.CodecName] = ["reference", "native"]


@pytest.fixture(params=NAMES)
def load(request: pytest.FixtureRequest) -> Callable[[Table], Codec]:
    """Return a function that makes codecs of one kind; each test runs with both kinds."""
    return lambda table: codecs.load(table, request.param)


def _rejection(codec: Codec, direction: Direction, data: bytes, of: str | None = None) -> Any:
    with pytest.raises(ProtocolError) as caught:
        codec.decode(direction, data, of=of)
    return caught.value.reason, caught.value.offset


def test_crc_is_that_of_modbus() -> None:
    assert crc16_modbus(b"123456789") == 0x4B37


@pytest.mark.parametrize("text", REAL)
def test_frame_of_a_real_arm_is_decoded_found_and_encoded(
    load: Callable[[Table], Codec], text: str
) -> None:
    codec, frame = load(B), bytes.fromhex(text)
    direction: Any
    direction, name, values = REAL[text]
    message = codec.decode(direction, frame, of=name)
    assert (message.command.name, message.values, message.address) == (name, values, None)
    assert codec.encode(name, direction, values) == frame
    assert codec.framer(direction).feed(b"\xfe" + frame)[-1] == Frame(1, frame, frame[3])


@pytest.mark.parametrize("text", OWN)
def test_frame_with_an_address_is_decoded_found_and_encoded(
    load: Callable[[Table], Codec], text: str
) -> None:
    codec, frame = load(C), bytes.fromhex(text)
    direction: Any
    direction, name, values, address = OWN[text]
    message = codec.decode(direction, frame)
    assert (message.command.name, message.values, message.address) == (name, values, address)
    assert codec.encode(name, direction, values, address=address) == frame
    assert codec.framer(direction).feed(b"\xfe" + frame)[-1] == Frame(1, frame, frame[4])


@pytest.mark.parametrize(
    ("table", "text", "reason", "offset", "words"),
    [
        (B, "FE FE 04 58 01 FD 88", "bad-check", 5, "the CRC is wrong"),
        (B, "FE FE 04 58 01 87 FD", "bad-check", 5, "the CRC is wrong"),
        (B, "FE FE 04 58 02 FD 87", "bad-check", 5, "the CRC is wrong"),
        (B, "FE FE 04 58 01 FD", "truncated", 6, "the last byte of the frame is missing"),
        (B, "FE FE 02 58 FD 87", "bad-length", 2, "LEN of the request 58 .* is 02; allowed: 04"),
        (C, "FE FE 01 02 10 11", "bad-check", 5, "the sum is wrong"),
        (C, "FE FE 04 02 10 10", "bad-address", 2, "the address is 04; allowed: 01, 00, 02, 03"),
        (C, "FE FE 01 03 10 10", "bad-length", 3, "LEN of the request 10 .* is 03; allowed: 02"),
        (C, "FE FE 01 02 11 11", "unknown-id", 4, "no request with id 11"),
        (C, "FE FE 01", "truncated", 3, "end before LEN"),
        (C, "FE FE 01 02 10 10 00", "trailing", 6, "LEN is 02, but more bytes follow"),
    ],
)
def test_damaged_frame_is_rejected_with_reason_and_offset(
    load: Callable[[Table], Codec],
    table: Table,
    text: str,
    reason: str,
    offset: int,
    words: str,
) -> None:
    codec, data = load(table), bytes.fromhex(text)
    with pytest.raises(ProtocolError, match=words) as caught:
        codec.decode("request", data)
    assert (caught.value.reason, caught.value.offset) == (reason, offset)
    framer = codec.framer("request")
    events = framer.feed(data) + framer.flush()
    if reason != "trailing":
        assert isinstance(events[0], Noise)
        assert (events[0].offset, events[0].reason) == (0, reason)


def test_first_address_is_sent_unless_another_is_given(
    load: Callable[[Table], Codec],
) -> None:
    codec = load(C)
    assert codec.encode("power_on", "request", ())[2] == 1
    assert codec.encode("power_on", "request", (), address=3)[2] == 3
    with pytest.raises(UsageError, match="address is 4; allowed: 1, 0, 2, 3"):
        codec.encode("power_on", "request", ("the address is checked before any value",), address=4)
    with pytest.raises(UsageError, match="address is 0; allowed: None"):
        load(B).encode("get_angles", "request", (), address=0)


def test_commands_with_the_same_id_and_size_are_distinguished_by_values(
    load: Callable[[Table], Codec],
) -> None:
    codec = load(ALIKE)

    def read(text: str, of: str | None = None) -> tuple[str, str]:
        message = codec.decode("request", bytes.fromhex(f"FEFE{text}FA"), of=of)
        return message.command.name, message.variant.fields[0].name

    assert read("04 60 01 05") == ("set_left", "side")
    assert read("04 60 02 05") == ("set_right", "side")
    assert read("03 61 09") == ("jog", "low")
    assert read("03 61 14") == ("jog", "high")
    assert read("03 61 0A") == ("jog_too", "any")
    assert read("03 61 09", of="jog_too") == ("jog_too", "any")
    with pytest.raises(ProtocolError, match="set_left: side is 3; allowed: 1"):
        read("04 60 03 05")
    with pytest.raises(ProtocolError, match="set_right: side is 1; allowed: 2"):
        read("04 60 01 05", of="set_right")


def test_named_command_restricts_the_variants(load: Callable[[Table], Codec]) -> None:
    codec = load(ALIKE)
    start = bytes.fromhex("FE FE 03 61")
    assert _rejection(codec, "request", start, "jog") == ("truncated", 4)
    assert _rejection(codec, "request", start, "set_left") == ("unknown-id", 3)
    assert _rejection(codec, "request", bytes.fromhex("FE FE 04 61"), "jog") == ("bad-length", 2)
    # A reply with that id and size exists, but it belongs to another command.
    assert _rejection(codec, "reply", start, "jog") == ("bad-length", 2)
    with pytest.raises(UsageError, match="did you mean jog"):
        codec.decode("request", start, of="jogg")


def test_first_variant_that_allows_the_values_is_encoded(load: Callable[[Table], Codec]) -> None:
    codec = load(ALIKE)
    assert codec.encode("jog", "request", (5,))[4] == 5
    assert codec.encode("jog", "request", (25,))[4] == 25
    assert codec.encode("jog", "request", (25,), variant=1)[4] == 25
    with pytest.raises(UsageError, match=r"low is 15; allowed: a whole number 0\.\.9"):
        codec.encode("jog", "request", (15,))
    with pytest.raises(UsageError, match=r"high is 5; allowed: a whole number 20\.\.29"):
        codec.encode("jog", "request", (5,), variant=1)
    with pytest.raises(UsageError, match=r"1 value given for the .*; it takes \(low\) or \(high\)"):
        codec.encode("jog", "request", (5,), variant=2)


# The framing laws, and the agreement of both codecs, for streams in all of these formats.
TABLES = [B, C, ALIKE]
PAIRS = st.sampled_from([tuple(codecs.load(table, name) for name in NAMES) for table in TABLES])
DIRECTIONS: st.SearchStrategy[Direction] = st.sampled_from(["request", "reply"])
LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])


@st.composite
def _frames(draw: st.DrawFn, table: Table, *, damaged: bool = False) -> bytes:
    """Draw a legal frame with any values; with ``damaged``, one or two bytes may be changed."""
    variants = [
        (command.id, variant)
        for command in table.commands
        for variant in command.request + command.reply
    ]
    id, variant = draw(st.sampled_from(variants))
    size = variant.size
    data = draw(st.binary(min_size=size, max_size=size))
    frame = table.frame
    address = [draw(st.sampled_from(frame.addresses))] if frame.addresses else []
    body = frame.header + bytes([*address, frame.length(size), id]) + data
    whole = bytearray(body + frame.end(body))
    for place in draw(st.lists(st.integers(0, len(whole) - 1), max_size=2)) if damaged else ():
        whole[place] = draw(st.integers(0, 255))
    return bytes(whole)


def _noise() -> st.SearchStrategy[bytes]:
    starts = st.sampled_from([HEADER, b"\xfe", b"\xfe\xfe\x04", b"\xfe\xfe\x01\x0e\x20"])
    return st.one_of(starts, st.binary(max_size=8), strategies.line_noise())


def _streams(table: Table) -> st.SearchStrategy[bytes]:
    pieces = st.one_of(_frames(table), _frames(table, damaged=True), _noise())
    return st.lists(pieces, max_size=8).map(b"".join)


def _outcome(action: Callable[[], Any]) -> Any:
    try:
        return action()
    except CobotwireError as error:
        return type(error), str(error), repr(vars(error))


def _cut(codec: Codec, listening: Listening, chunks: list[bytes]) -> list[Event]:
    """Return all events, with adjacent noise of one reason joined."""
    framer = codec.framer(listening)
    events: list[Event] = []
    for event in [event for chunk in chunks for event in framer.feed(chunk)] + framer.flush():
        last = events[-1] if events else None
        if isinstance(event, Noise) and isinstance(last, Noise) and last.reason == event.reason:
            events[-1] = Noise(last.offset, last.data + event.data, last.reason)
        else:
            events.append(event)
    return events


@given(PAIRS, LISTENING, st.booleans(), st.data())
def test_both_framers_return_the_same_events(
    pair: tuple[Codec, Codec], listening: Listening, accept_unknown: bool, data: st.DataObject
) -> None:
    stream = data.draw(_streams(pair[0].table))
    framers = [codec.framer(listening, accept_unknown=accept_unknown) for codec in pair]
    for chunk in data.draw(strategies.chunked(stream)):
        assert framers[0].feed(chunk) == framers[1].feed(chunk)
        assert framers[0].pending == framers[1].pending
    assert framers[0].flush() == framers[1].flush()


@given(PAIRS, DIRECTIONS, st.data())
def test_both_codecs_decode_a_message_alike_or_reject_it_at_the_same_byte(
    pair: tuple[Codec, Codec], direction: Direction, data: st.DataObject
) -> None:
    table = pair[0].table
    frame = data.draw(_frames(table) | _frames(table, damaged=True))
    frame = frame[: data.draw(st.integers(0, len(frame)) | st.just(len(frame)))]
    of = data.draw(st.none() | st.sampled_from([command.name for command in table.commands]))
    reference, native = (
        _outcome(lambda codec=codec: codec.decode(direction, frame, of=of))  # type: ignore[misc]
        for codec in pair
    )
    assert reference == native


@given(PAIRS, DIRECTIONS, st.data())
def test_both_codecs_encode_a_frame_alike_or_reject_it_with_the_same_message(
    pair: tuple[Codec, Codec], direction: Direction, data: st.DataObject
) -> None:
    command = data.draw(st.sampled_from(pair[0].table.commands))
    number = st.integers(-5, 40) | st.floats(-400, 400)
    values = data.draw(st.lists(number | st.lists(number, min_size=6, max_size=6), max_size=2))
    variant = data.draw(st.none() | st.integers(-1, 2))
    address = data.draw(st.none() | st.integers(-1, 4))
    reference, native = (
        _outcome(
            lambda codec=codec: codec.encode(  # type: ignore[misc]
                command.name, direction, values, variant=variant, address=address
            )
        )
        for codec in pair
    )
    assert reference == native


@given(PAIRS, LISTENING, st.data())
def test_every_byte_is_in_one_event_for_any_chunking(
    pair: tuple[Codec, Codec], listening: Listening, data: st.DataObject
) -> None:
    stream = data.draw(_streams(pair[0].table))
    chunks = data.draw(strategies.chunked(stream))
    for codec in pair:
        events = _cut(codec, listening, chunks)
        assert b"".join(event.data for event in events) == stream
        assert all(a.offset + len(a.data) == b.offset for a, b in pairwise(events))
        assert events == _cut(codec, listening, [stream])


@given(PAIRS, st.data())
def test_undamaged_frame_is_found_unless_a_legal_one_covers_it(
    pair: tuple[Codec, Codec], data: st.DataObject
) -> None:
    table = pair[0].table
    before, frame = data.draw(_streams(table)), data.draw(_frames(table))
    chunks = [before, frame, data.draw(_noise())]
    start = len(before)
    for codec in pair:
        events = _cut(codec, "both", chunks)
        if Frame(start, frame, frame[table.frame.overhead]) not in events:
            covers = [e for e in events if isinstance(e, Frame) and e.offset < start]
            assert covers[-1].offset + len(covers[-1].data) > start


@VARIANTS
def test_unknown_id_is_accepted_on_request_if_its_check_is_right(
    load: Callable[[Table], Codec], table: Table
) -> None:
    frame = table.frame
    body = HEADER + bytes([*frame.addresses[:1], frame.length(1), 0xE0, 7])
    whole = body + frame.end(body)
    codec = load(table)
    assert codec.framer("reply", accept_unknown=True).feed(whole) == [Frame(0, whole, 0xE0)]
    assert all(isinstance(event, Noise) for event in codec.framer("reply").feed(whole))
    broken = whole[:-1] + bytes([whole[-1] ^ 1])
    [first, *_] = codec.framer("reply", accept_unknown=True).feed(broken)
    assert isinstance(first, Noise)
    assert first.reason == "bad-check"
