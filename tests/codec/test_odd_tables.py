"""Run both codecs on tables that no edition has: signs of zero, order and sizes of lists."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

import small_tables
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame, Listening, Noise
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.frame_format import Unsigned
from cobotwire.protocol.numbers import raw_of_float
from cobotwire.protocol.table import Case, Table, Variant


def both(table: Table) -> tuple[Codec, Codec]:
    return codecs.load(table, "reference"), codecs.load(table, "native")


BOUNDED = small_tables.field("a", small_tables.number(1, 1, 1))
# The highest finite float of four bytes.
MOST = 2.0**128 - 2.0**104
SCALES = [(-1, 10), (1, -10), (-1, 1), (-7, 100), (-3, -20), (1, 10)]


@pytest.mark.parametrize("frames", [2, 40_000])
def test_rejected_frames_are_listed_in_the_order_of_the_stream(frames: int) -> None:
    """This holds for interleaved commands, and where the native codec reads whole blocks."""
    request = (Variant((BOUNDED,)),)
    table = small_tables.table(*(small_tables.command(id, f"c{id}", request) for id in (9, 5, 7)))
    each = [table.frame.enclose(id, b"\0") for id in (7, 9, 5, 9, 7)]
    stream = b"".join(each[index % 5] for index in range(frames))
    expected = list(range(0, 6 * frames, 6))
    for codec in both(table):
        if codec.name == "native" or frames < 100:
            assert codec.decode_columns(stream, "request").rejected.tolist() == expected
            reader = codec.column_reader("request")
            parts = [reader.feed(stream[:7]), reader.feed(stream[7:]), reader.flush()]
            assert [at for part in parts for at in part.rejected.tolist()] == expected


class Broken:
    """A value whose conversion raises an error of its own."""

    def __index__(self) -> int:
        raise ZeroDivisionError

    __float__ = __index__


def test_error_of_a_conversion_is_raised_unless_a_value_before_it_is_wrong() -> None:
    row = small_tables.field("row", small_tables.number(), small_tables.number(), many=True)
    table = small_tables.table(small_tables.command(1, "set", (Variant((row, BOUNDED)),)))
    for codec in both(table):
        for values in (((Broken(), 999), 1), ((0, Broken()), 1), ((0, 0), Broken())):
            with pytest.raises(ZeroDivisionError):
                codec.encode("set", "request", values)
        for wrong in (((999, Broken()), 1), ((), Broken()), (0, Broken()), ((0, 999), Broken())):
            with pytest.raises(UsageError, match="row"):
                codec.encode("set", "request", wrong)


def test_value_halfway_between_two_raw_values_rounds_to_the_even_one() -> None:
    half = small_tables.field("half", small_tables.number(scale=(1, 2)))
    for codec in both(small_tables.table(small_tables.command(1, "set", (Variant((half,)),)))):
        frames = [codec.encode("set", "request", (value,)) for value in (0.25, 0.75, 1.25)]
        assert [frame[4] for frame in frames] == [0, 2, 2]


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("width", [1, 2, 3, 4])
@pytest.mark.parametrize("times", [1, 5_000])
def test_zero_of_a_negative_scale_has_the_sign_that_the_reference_gives_it(
    scale: tuple[int, int], width: int, times: int
) -> None:
    number = small_tables.number(width, -(256**width) // 2, scale=scale)
    kinds = [
        small_tables.field("one", number),
        small_tables.field("row", number, number, many=True),
        small_tables.field("chosen", number, choices=(0, 1)),
    ]
    for field in kinds:
        table = small_tables.table(small_tables.command(1, "set", (Variant((field,)),)))
        frame = table.frame.enclose(1, bytes(field.size))
        reference, native = both(table)
        expected = repr(reference.decode_columns(frame)[0][field.name].tolist()[0])
        assert repr(native.decode("request", frame).values[0]).strip("()") == expected.strip("[]")
        column = native.decode_columns(frame * times)[0][field.name].tolist()
        assert [repr(value) for value in column] == [expected] * times


@pytest.mark.parametrize("listening", ["request", "reply", "both"])
@pytest.mark.parametrize("direction", [None, "request", "reply"])
def test_error_about_an_unknown_id_names_the_requested_direction(
    listening: Listening, direction: Any
) -> None:
    empty = (Variant(()),)
    table = small_tables.table(small_tables.command(1, "get", empty, empty))
    stream = table.frame.enclose(0x77, b"")
    meant = direction or ("request" if listening == "both" else listening)
    for codec in both(table):
        [frame] = codec.framer(listening, accept_unknown=True).feed(stream)
        assert isinstance(frame, Frame)
        actions: list[Callable[[], Any]] = [lambda: frame.decode(direction)]  # noqa: B023
        if direction is None:
            actions += [lambda: frame.message, lambda: frame.values]  # noqa: B023
        for action in actions:
            with pytest.raises(ProtocolError, match=f"small has no {meant} with id 77"):
                action()


def test_counted_list_takes_the_variant_of_its_size_and_names_the_element_at_fault() -> None:
    joint = (
        small_tables.number(2, -300, 300)._replace(name="angle"),
        small_tables.number(1, 0, 90)._replace(name="temperature"),
    )
    variants = []
    for size in range(4):
        count = small_tables.field("n", small_tables.number(), choices=(size,))._replace(const=size)
        counted = count._replace(counts="joints", sizes=(0, 3))
        listed = small_tables.field("joints", *(joint * size), many=True)
        variants.append(Variant((counted, listed._replace(each=2, sizes=(0, 3)))))
    table = small_tables.table(small_tables.command(1, "set_joints", tuple(variants)))
    for codec in both(table):
        frame = codec.encode("set_joints", "request", (..., [(-3, 20), (300, 90)]))
        assert frame.hex(" ") == "fe fe 09 01 02 ff fd 14 01 2c 5a fa"
        assert codec.decode("request", frame).values == (2, ((-3, 20), (300, 90)))
        wrong: list[tuple[list[Any], str]] = [
            ([(0, 0), (0, 91)], r"joints\[1\].temperature is 91; allowed: a whole number 0..90"),
            ([(0, 0), 5], r"joints\[1\] is 5; allowed: a sequence of 2 numbers \(angle, temp"),
            ([(0, 0)] * 4, r"len\(joints\) is 4; allowed: 0..3"),
        ]
        for joints, message in wrong:
            with pytest.raises(UsageError, match=message):
                codec.encode("set_joints", "request", (..., joints))


def test_text_may_be_empty_or_full_and_a_wrong_one_is_named_with_index_and_sizes() -> None:
    letters = [small_tables.number()] * 6
    texts = small_tables.field("names", *letters, many=True)._replace(
        kind="text",
        each=3,
        encoding="latin-1",
        padding=0,
    )
    sized = small_tables.field("label", *letters[:2], many=True)._replace(
        kind="text",
        encoding="latin-1",
        sizes=(1, 2),
    )
    wrong: list[tuple[Any, Any, str]] = [
        (texts, ("ab", "€"), r"names\[1\] is '€'"),
        (texts, ("abcd", "b"), r"names\[0\] is 'abcd'"),
        (sized, "€", r"label is '€'; allowed: Latin-1 text of 1..2 bytes"),
        (sized._replace(sizes=None), "€", r"label is '€'; allowed: Latin-1 text of 2 bytes"),
    ]
    for field, value, message in wrong:
        table = small_tables.table(small_tables.command(1, "set", (Variant((field,)),)))
        for codec in both(table):
            with pytest.raises(UsageError, match=message):
                codec.encode("set", "request", (value,))
    legal: list[tuple[Any, Any]] = [
        (texts, ("", "b")),
        (texts._replace(encoding="utf-8"), ("ä", "€")),
        (sized._replace(sizes=None), "ab"),
        (sized._replace(cases=(Case((), ()),), sizes=(0, 2)), ""),
    ]
    for field, value in legal:
        table = small_tables.table(small_tables.command(1, "set", (Variant((field,)),)))
        for codec in both(table):
            frame = codec.encode("set", "request", (value,))
            assert codec.decode("request", frame).values == (value,)


@pytest.mark.parametrize(
    ("id", "data", "reason"),
    [
        (0x1234, b"\1\1", "bad-length"),
        (0x1299, b"\1\1", "bad-length"),
        (0x1299, b"\1", "unknown-id"),
    ],
)
def test_candidate_with_a_wide_id_is_noise_with_its_reason(
    id: int, data: bytes, reason: str
) -> None:
    wide = small_tables.FOOTER._replace(id_number=Unsigned(2, "big"))
    command = small_tables.command(0x1234, "set", (Variant((BOUNDED,)),))
    for codec in both(small_tables.table(command, frame=wide)):
        assert codec.encode("set", "request", (1,)) == wide.enclose(0x1234, b"\1")
        first = codec.framer("request").feed(wide.enclose(id, data))[0]
        assert isinstance(first, Noise)
        assert first.reason == reason


@pytest.mark.parametrize(("low", "raw"), [(-127, b"\x80"), (-32767, b"\x80\0")])
def test_lowest_value_of_the_wire_is_rejected_in_columns_if_the_bounds_exclude_it(
    low: int, raw: bytes
) -> None:
    field = small_tables.field("a", small_tables.number(len(raw), low))
    table = small_tables.table(small_tables.command(1, "set", (Variant((field,)),)))
    for codec in both(table):
        columns = codec.decode_columns(table.frame.enclose(1, raw), "request")
        assert columns.rejected.tolist() == [0]


@pytest.mark.parametrize(
    ("ends", "value", "allowed"),
    [
        ((-MOST, MOST), math.inf, "a finite number of 4 bytes"),
        ((-math.inf, math.nan), "much", "a number, also infinity and NaN"),
        ((-0.5, 1.5), math.nan, "a number -0.5..1.5"),
    ],
)
def test_wrong_float_is_named_with_what_is_allowed(
    ends: tuple[float, float], value: Any, allowed: str
) -> None:
    low, high = (raw_of_float(end, 4) for end in ends)
    number = small_tables.number(4, low, high)._replace(encoding="float")
    field = small_tables.field("weight", number)
    for codec in both(small_tables.table(small_tables.command(1, "set", (Variant((field,)),)))):
        with pytest.raises(UsageError, match=f"^weight is {value!r}; allowed: {allowed}$"):
            codec.encode("set", "request", (value,))
