"""Every Hypothesis strategy, made from an edition's own table; left out: from ``mycobot``'s."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

from hypothesis import strategies as st

import line
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.table import Case, Command, Direction, Field, Layout, Number, Table

TABLES = {table.edition: table for table in (TABLE, TABLE_280)}


class Form(NamedTuple):
    """One form of one message; ``number`` tells it from the command's others."""

    command: Command
    direction: Direction
    layout: Layout
    number: int


def forms_of(table: Table) -> list[Form]:
    """Every form of every message of an edition."""
    return [
        Form(command, direction, layout, index)
        for command in table.commands
        for direction in ("request", "reply")
        for index, layout in enumerate(command.layouts(direction))
    ]


FORMS = forms_of(TABLE)


@lru_cache
def codec_of(edition: str, name: codecs.CodecName) -> Codec:
    """One codec of an edition, made once."""
    return codecs.load(TABLES[edition], name)


def forms(table: Table = TABLE) -> st.SearchStrategy[Form]:
    """Any form of any message of the edition."""
    return st.sampled_from(FORMS if table is TABLE else forms_of(table))


def _whole(field: Field, number: Number) -> st.SearchStrategy[int]:
    if field.choices:
        return st.sampled_from(field.choices)
    return st.integers(number.minimum, number.maximum)


def _value(field: Field, number: Number) -> st.SearchStrategy[Any]:
    whole = _whole(field, number)
    if field.kind == "flag":
        return whole.map(bool)
    if number.scaled:
        return whole.map(lambda steps: steps * number.multiply / number.divide)
    return whole


def _of_case(field: Field, case: Case) -> st.SearchStrategy[Any]:
    elements = [_value(field, number) for number in case.numbers]
    return st.tuples(*elements) if field.many else elements[0]


@st.composite
def legal_values(draw: st.DrawFn, layout: Layout) -> tuple[Any, ...]:
    """Values that the layout allows, each on a step of its scale."""
    values: list[Any] = [
        draw(_of_case(field, field.cases[0])) if field.selector < 0 else None
        for field in layout.fields
    ]
    for index, field in enumerate(layout.fields):
        if field.selector >= 0:
            picked = values[field.selector]
            case = next(case for case in field.cases if picked in case.when)
            values[index] = draw(_of_case(field, case))
    return tuple(values)


def messages(table: Table = TABLE) -> st.SearchStrategy[tuple[Form, tuple[Any, ...]]]:
    """Any legal message: its form and its values."""
    return forms(table).flatmap(lambda form: st.tuples(st.just(form), legal_values(form.layout)))


def odd_values() -> st.SearchStrategy[Any]:
    """Values of all kinds, most of which no field allows."""
    scalars = st.one_of(
        st.floats(),
        st.integers(),
        st.integers(-70_000, 70_000),
        st.floats(-700, 700),
        st.booleans(),
        st.none(),
        st.text(max_size=3),
        st.binary(max_size=3),
        st.fractions(),
        st.decimals(allow_nan=True),
        st.complex_numbers(),
    )
    rows = st.lists(st.one_of(st.floats(-700, 700), scalars), max_size=8)
    return st.one_of(scalars, rows, rows.map(tuple), st.dictionaries(st.text(max_size=1), scalars))


@st.composite
def any_arguments(draw: st.DrawFn, table: Table = TABLE) -> tuple[str, Direction, tuple[Any, ...]]:
    """A message with values of which some, or all, or none, are allowed."""
    form, values = draw(messages(table))
    spoilt = [draw(odd_values()) if draw(st.integers(0, 3)) == 0 else value for value in values]
    if draw(st.integers(0, 9)) == 0:
        spoilt.append(draw(odd_values()))
    return form.command.name, form.direction, tuple(spoilt)


def near_frames(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """What looks like a frame for some bytes, and is none or is one by chance."""
    longest = table.frame.maximum_length
    lengths = st.integers(0, longest + 4)
    ids = st.sampled_from([command.id for command in table.commands]) | st.integers(0, 255)
    return st.builds(
        lambda length, id, rest: table.frame.header + bytes([length, id]) + rest,
        lengths,
        ids,
        st.binary(max_size=longest + 2),
    )


def real_frames(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """A legal frame, built by the reference codec."""
    codec = codec_of(table.edition, "reference")
    return messages(table).map(lambda message: frame_of(codec, *message))


def frame_of(codec: Codec, form: Form, values: tuple[Any, ...]) -> bytes:
    """The frame of a message, in just that form."""
    return codec.encode(form.command.name, form.direction, values, form=form.number)


def line_noise(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """Noise as a line carries it: servo packets, text, NULs, half headers, and anything."""
    return line.line_noise(table)


def received(table: Table, listening: Listening) -> st.SearchStrategy[line.Received]:
    """Frames of what is listened to as they come in over a bad line, and which came whole."""
    codec = codec_of(table.edition, "reference")
    heard = [form for form in forms_of(table) if listening in (form.direction, "both")]
    frames = (
        st.sampled_from(heard)
        .flatmap(lambda form: st.tuples(st.just(form), legal_values(form.layout)))
        .map(lambda message: frame_of(codec, *message))
    )
    return line.received(frames, table)


def streams(table: Table = TABLE) -> st.SearchStrategy[bytes]:
    """What may stand on a line: frames, near frames and noise in any order."""
    pieces = st.one_of(real_frames(table), near_frames(table), line_noise(table))
    return st.lists(pieces, max_size=8).map(b"".join)


@st.composite
def chunked(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """``data`` in pieces, some of them empty."""
    cuts = sorted(draw(st.lists(st.integers(0, len(data)), max_size=10)))
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)])]


def servo_packet(body: bytes) -> bytes:
    """A packet of the servo bus: ``body`` is ID, LEN, instruction or error, and parameters."""
    return b"\xff\xff" + body + bytes([~sum(body) & 0xFF])


def servo_packets() -> st.SearchStrategy[bytes]:
    """A servo packet with a right checksum."""
    codes = st.sampled_from([0, 1, 2, 3, 4, 5, 0x20, 0x82, 0x83]) | st.integers(0, 255)
    return st.builds(
        lambda id, code, rest: servo_packet(bytes([id, len(rest) + 2, code]) + rest),
        st.sampled_from([1, 2, 7, 0xFE]) | st.integers(0, 0xFE),
        codes,
        st.binary(max_size=12),
    )


PANIC = (
    b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n\r\n"
    b"Core  1 register dump:\r\n"
    b"PC      : 0x400d15f4  PS      : 0x00060b30  A0      : 0x800d0b5c  A1      : 0x3ffb1f60\r\n"
    b"EXCVADDR: 0x00000004  LBEG    : 0x4000c2e0  LEND    : 0x4000c2f6  LCOUNT  : 0x00000000\r\n"
    b"\r\nBacktrace: 0x400d15f1:0x3ffb1f60 0x400d0b59:0x3ffb1f90 0x40088b9d:0x3ffb1fb0\r\n\r\n"
    b"Rebooting...\r\n"
)


def spoilt_panics() -> st.SearchStrategy[bytes]:
    """A panic with some bytes in its middle that are no text."""
    return st.builds(
        lambda cut, bad: PANIC[:cut] + bad + PANIC[cut:],
        st.integers(21, len(PANIC)),
        st.lists(st.integers(0x80, 0xFF), max_size=6).map(bytes),
    )


def damaged_replies() -> st.SearchStrategy[bytes]:
    """The beginning of a get_angles reply, with or without a footer at the wrong place."""
    return st.builds(
        lambda size, footer: (b"\xfe\xfe\x0e\x20" + bytes(range(16)))[:size] + footer,
        st.integers(1, 19),
        st.sampled_from([b"", b"\xfa", b"\xfb"]),
    )


def field_noise() -> st.SearchStrategy[bytes]:
    """What firmware, servos and bad lines say, whole or broken off, short and long."""
    whole = st.one_of(
        servo_packets(),
        st.sampled_from(
            [PANIC, b"cmd_len error\r\n", b"cmd_len error", b"ets Jul 29 2019 12:21:46\r\n\r\n"]
        ),
        st.sampled_from([1, 3, 4, 63, 64, 277, 5000]).map(bytes),
        st.integers(1, 3000).map(lambda size: b"~" * size),
        st.binary(max_size=300),
        line_noise(),
        spoilt_panics(),
        # A message at a line's limit, and right behind a frame that breaks off.
        st.integers(1000, 1050).map(lambda size: b"x" * size + b"cmd_len error"),
        st.builds(
            lambda parts, behind: b"".join(parts) + behind,
            st.lists(damaged_replies(), min_size=1, max_size=4),
            st.sampled_from([b"", b"cmd_len error\r\n", PANIC]) | servo_packets(),
        ),
    )
    return st.one_of(
        whole, st.builds(lambda data, cut: data[: cut % (len(data) + 1)], whole, st.integers(0))
    )


@st.composite
def field_streams(draw: st.DrawFn, table: Table = TABLE) -> bytes:
    """Frames and field noise; sometimes a frame stands in the middle of a piece of noise."""
    stream = b""
    for piece in draw(
        st.lists(field_noise() | real_frames(table) | near_frames(table), max_size=6)
    ):
        cut = draw(st.integers(0, len(piece))) if draw(st.booleans()) else len(piece)
        stream += piece[:cut]
        if cut < len(piece):
            stream += draw(real_frames(table)) + piece[cut:]
    return stream
