"""Random tables and streams of their frames, wider than the spec's language.

Scales may be negative in their numerator or denominator, several commands share an id, fields have
selectors, and the frames on the line hold any raw values, allowed or not.

The strategies are constants, or cached: Hypothesis validates each object once, which would take a
third of the time of a test if each draw made new ones.
"""

from __future__ import annotations

from functools import cache
from typing import Any, Literal

from hypothesis import strategies as st

import strategies
from cobotwire.editions.mybuddy import TABLE as MYBUDDY
from cobotwire.protocol.numbers import raw_of_float
from cobotwire.protocol.table import (
    Case,
    Command,
    Field,
    Number,
    Table,
    Variant,
)
from json_tables import sample
from random_formats import frame_formats

SCALES = st.sampled_from(
    [(1, 1), (1, 10), (-1, 10), (1, -10), (-1, 1), (3, -20), (-7, 100), (-1, -1), (1, 3)]
)
ORDERS: st.SearchStrategy[Literal["big", "little"]] = st.sampled_from(["big", "big", "little"])
WIDTHS, FIELD_WIDTHS = st.sampled_from([1, 1, 2, 2, 3, 4]), st.sampled_from([1, 2, 4, 8])
WORD_WIDTHS = st.sampled_from([1, 2, 4])
SHAPES = st.sampled_from(["bits", "bytes", "text", "texts", "rows"])
SIZES = st.sampled_from([None, (0, 5)])
ENCODINGS, PADDINGS = st.sampled_from(["ascii", "utf-8", "latin-1"]), st.sampled_from([-1, 0, 32])
BIT_KINDS = st.sampled_from(["number", "flag", "enum"])


@cache
@st.composite
def numbers(draw: st.DrawFn, width: int | None = None) -> Number:
    """Draw a number with any sign rule, scale and bounds, or a float."""
    if width == 8 or (width == 4 and draw(st.booleans())):
        return draw(floats(width))
    width = width or draw(WIDTHS)
    top = 256**width - 1
    signed_at = draw(_signs(top))
    lowest = 0 if signed_at == top else signed_at - top
    low, high = lowest, signed_at
    if draw(st.booleans()):
        low, high = sorted([draw(st.integers(lowest, signed_at)) for _ in range(2)])
    order, scale = draw(ORDERS), draw(SCALES)
    return Number("", width, order, signed_at, *scale, low, high, "")


@cache
def _signs(top: int) -> st.SearchStrategy[int]:
    return st.sampled_from([top, top // 2, 0]) | st.integers(0, top)


@cache
@st.composite
def floats(draw: st.DrawFn, width: int) -> Number:
    """Draw a float with any bounds, or one that may also be infinite or not a number."""
    order = draw(ORDERS)
    beyond = raw_of_float(float("inf"), width)
    low, high = -beyond, beyond - 1
    kind = draw(st.integers(0, 2))
    if kind == 0:
        low, high = -(256**width) // 2, 256**width // 2 - 1
    elif kind == 1:
        low, high = sorted([draw(st.integers(low, high)) for _ in range(2)])
    return Number("", width, order, 0, 1, 1, low, high, "", "float")


@cache
@st.composite
def fields(draw: st.DrawFn, name: str, selector: int = -1) -> Field:
    """Draw a field of one number or of an array, under a selector if it is given."""
    if draw(st.integers(0, 3)) == 0:
        return draw(shaped_fields(name))
    many = draw(st.booleans())
    widths = [draw(FIELD_WIDTHS) for _ in range(draw(st.integers(1, 4)) if many else 1)]
    whens: list[tuple[int, ...]] = [()] if selector < 0 else [(0,), (1, 2)]
    cases = tuple(Case(when, tuple(draw(numbers(width)) for width in widths)) for when in whens)
    choices: tuple[int, ...] = ()
    if not many and draw(st.integers(0, 3)) == 0:
        legal = st.integers(cases[0].numbers[0].minimum, cases[0].numbers[0].maximum)
        choices = tuple(draw(st.lists(legal, min_size=1, max_size=3, unique=True)))
    return Field(name, "number", cases, "", many, choices, (), selector)


@cache
@st.composite
def shaped_fields(draw: st.DrawFn, name: str) -> Field:
    """Draw bits, bytes, a text, a list of texts, or a list of rows."""
    kind = draw(SHAPES)
    sizes = draw(SIZES)
    count, each = draw(st.integers(0, 3)), draw(st.integers(1, 4))
    if kind == "bits":
        return Field(name, "number", (Case((), draw(bits())),), "", True)
    if kind == "rows":
        group = tuple([draw(numbers(1)) for _ in range(each - 1)])
        group += draw(bits()) if draw(st.booleans()) else (draw(numbers(2)),)
        case = Case((), group * count)
        return Field(name, "number", (case,), "", True, each=len(group), sizes=sizes)
    byte = Number("", 1, "big", 255, 1, 1, 0, 255, "")
    encoding = draw(ENCODINGS) if kind != "bytes" else ""
    if encoding == "ascii":
        byte = byte._replace(maximum=127)
    padding = draw(PADDINGS) if kind != "bytes" else -1
    case = Case((), (byte,) * (count * each))
    shape: Literal["bytes", "text"] = "bytes" if kind == "bytes" else "text"
    of = each if kind == "texts" else 0
    texts: dict[str, Any] = {"each": of, "encoding": encoding, "padding": padding, "sizes": sizes}
    return Field(name, shape, (case,), "", True, **texts)


@cache
@st.composite
def bits(draw: st.DrawFn) -> tuple[Number, ...]:
    """Draw the numbers of a word, some of them flags or with a list of choices."""
    width, order = draw(WORD_WIDTHS), draw(ORDERS)
    found: list[Number] = []
    shift = 0
    while shift < 8 * width and len(found) < 4:
        count = draw(st.integers(1, 8 * width - shift))
        top = 2**count - 1
        signed_at = draw(st.sampled_from([top, top // 2]))
        low = 0 if signed_at == top else signed_at - top
        kind = draw(BIT_KINDS)
        choices = {"number": (), "flag": (0, 1), "enum": (low, signed_at)}[kind]
        number = Number("b", width, order, signed_at, 1, 1, low, signed_at, "")
        flag: Literal["number", "flag"] = "flag" if kind == "flag" else "number"
        if kind == "flag":
            number = number._replace(signed_at=top, minimum=0, maximum=1)
        number = number._replace(kind=flag, choices=choices, shift=shift, bits=count, more=True)
        found.append(number)
        shift += count
    return (*found[:-1], found[-1]._replace(more=False))


@cache
@st.composite
def variants(draw: st.DrawFn) -> Variant:
    """Draw up to three fields; a field may be the selector of the next one."""
    found: list[Field] = []
    for index in range(draw(st.integers(0, 3))):
        plain = index > 0 and not found[-1].many and found[-1].selector < 0
        selector = index - 1 if plain and draw(st.booleans()) else -1
        found.append(draw(fields(f"f{index}", selector)))
    return Variant(tuple(found))


REQUESTS = st.lists(variants(), min_size=1, max_size=2)


@cache
def _replies(least: int) -> st.SearchStrategy[list[Variant]]:
    """Draw the variants of a reply, each with at least ``least`` bytes."""
    return st.lists(variants().filter(lambda variant: variant.size >= least), max_size=2)


@cache
@st.composite
def tables(draw: st.DrawFn) -> Table:
    """Draw a table of up to four commands on up to three ids."""
    format = draw(frame_formats())
    ids = [0, 0x20, 0xFE] if format.id_number.width == 1 else [0, 0x20, 0x20FE]
    # A reply without an id has data in its place.
    least = 0 if format.reply_has_id else format.id_number.width
    replies = _replies(least)
    commands = [
        Command(
            draw(st.sampled_from(ids)),
            f"call{index}",
            "",
            "",
            "test",
            "query",
            100,
            tuple(draw(REQUESTS)),
            tuple(draw(replies)),
        )
        for index in range(draw(st.integers(1, 4)))
    ]
    return Table("random", "A random table", 6, 115200, format, tuple(commands))


@st.composite
def frames(draw: st.DrawFn, table: Table, *, unknown: bool = True) -> bytes:
    """Draw a frame of the table with any data bytes; with ``unknown`` also of any id and size."""
    command = draw(st.sampled_from(table.commands))
    # An event has no request, and some requests have no reply.
    directions = [each for each in strategies.DIRECTIONS if command.variants(each)]
    direction = draw(st.sampled_from(directions))
    variant = draw(st.sampled_from(command.variants(direction)))
    id, size = command.id, variant.size
    if unknown and draw(st.integers(0, 4)) == 0:
        id, size = draw(st.integers(0, 255)), draw(st.integers(2, 40))
    data = draw(
        st.sampled_from([bytes(size), b"\xff" * size]) | st.binary(min_size=size, max_size=size)
    )
    addresses = st.sampled_from(table.frame.addresses or [None])
    address = draw(st.none() | addresses if unknown else addresses)
    return table.frame.enclose(id, data, address, direction)


def streams(table: Table) -> st.SearchStrategy[bytes]:
    """Draw frames with a little noise between them."""
    pieces: Any = st.one_of(frames(table), frames(table), frames(table), st.binary(max_size=3))
    return st.lists(pieces, max_size=8).map(b"".join)


# The maker's other formats: an edition with addresses, and samples that no edition has.
FORMATS = [MYBUDDY, *map(sample, ("crc", "sum", "alike"))]


@cache
def any_tables() -> st.SearchStrategy[Table]:
    """Draw the table of an edition or of one of the maker's other formats, or a random one."""
    return st.sampled_from([*strategies.TABLES.values(), *FORMATS]) | tables()


def any_streams(table: Table) -> st.SearchStrategy[bytes]:
    """Draw the bytes of a line with frames of any table."""
    return streams(table) if table.edition == "random" else strategies.streams(table)


@st.composite
def values(draw: st.DrawFn, variant: Variant) -> tuple[Any, ...]:
    """Draw a value for each field, most of them legal ones."""
    found: list[Any] = []
    for field, value in zip(variant.fields, draw(strategies.legal_values(variant))):
        if draw(st.integers(0, 2)):
            found.append(value)
        elif field.kind == "bytes":
            found.append(draw(st.sampled_from([bytearray, memoryview, list]))(value))
        else:
            found.append(_changed(draw, value, [_beyond(n) for n in field.cases[0].numbers]))
    return tuple(found)


def _changed(draw: st.DrawFn, value: Any, others: list[float]) -> Any:
    """Return a value in which one part is replaced: by one of the others, or by an odd value."""
    if isinstance(value, tuple) and value and draw(st.integers(0, 4)):
        at = draw(st.integers(0, len(value) - 1))
        return (*value[:at], _changed(draw, value[at], others), *value[at + 1 :])
    return draw(st.sampled_from([*others, 0]) | strategies.odd_values())


def _beyond(number: Number) -> float:
    """Return the first value above those that a number allows."""
    above = number.maximum + 1
    highest = 256**number.width // 2 - 1
    return number.physical(min(above, highest) if number.encoding == "float" else above)
