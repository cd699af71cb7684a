"""Random types of a spec: numbers, enums, value types, bits, bytes, texts and lists."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from hypothesis import strategies as st

from cobotwire_codegen.units import UNITS
from random_values import decimal

Record = dict[str, Any]

# Each multiple of these scales is a finite decimal, so a vector can state it exactly.
SCALES = ["1", "1/10", "1/100", "1/1000", "1/8", "3/20", "5", "1/2"]
# The types of fields with a fixed size, which may stand anywhere in a message.
FIXED = ["joint", "q0", "q1", "flag", "mode", "row", "word", "octets", "name", "numbers", "pairs"]
# The types of fields with a varying size.
VARYING = ["blob", "note", "some", "groups"]


@st.composite
def types(draw: st.DrawFn) -> Record:
    """Draw a types file; every type exists, whether or not a message uses it."""
    wires = draw(_wires())
    quantities = {f"q{index}": draw(quantity(wires)) for index in range(draw(st.integers(2, 4)))}
    names = st.sampled_from(sorted(quantities))
    members = draw(st.lists(st.integers(0, 255), min_size=1, max_size=4, unique=True))
    items = draw(st.lists(names, min_size=1, max_size=4))
    return {
        "wire": wires,
        "quantities": {
            "joint": {"wire": "byte", "range": [1, 3], "doc": "A joint."},
            "wide": {"wire": "double", "range": [1, 3], "doc": "Two bytes."},
            "tag": {"wire": "byte", "scale": "1/10", "doc": "A tag."},
            "count": {"wire": draw(st.sampled_from(["byte", "double"])), "doc": "A count."},
            **quantities,
        },
        "flags": {"flag": {"wire": "byte", "doc": "Yes or no."}},
        "enums": {
            "mode": _enum("Mode", {f"M{value}": value for value in members}),
            "few": _enum("Few", {"NONE": 0, "ONE": 1, "BOTH": 3}),
            "status": _enum("Status", {"REFUSED": 0, "ACCEPTED": 1, "BUSY": 7}),
        },
        "values": {
            "row": _value("Row", {f"i{index}": name for index, name in enumerate(items)}),
            "pair": _value("Pair", {"left": draw(names), "right": draw(names)}),
        },
        **draw(_shapes()),
    }


@st.composite
def _wires(draw: st.DrawFn) -> Record:
    wires: Record = {
        "byte": {"bytes": 1, "doc": "A byte."},
        "double": {"bytes": 2, "doc": "Two bytes."},
    }
    for index in range(draw(st.integers(1, 3))):
        width = draw(st.integers(1, 4))
        top = 256**width - 1
        signs = st.sampled_from([top, top // 2]) | st.integers(0, top)
        order = draw(st.sampled_from(["big", "little"]))
        sign = draw(signs)
        wires[f"w{index}"] = {"bytes": width, "order": order, "signed_at": sign, "doc": "A wire."}
        if draw(st.integers(0, 4)) == 0:
            size = draw(st.sampled_from([4, 8]))
            wires[f"w{index}"] = {"bytes": size, "order": order, "encoding": "float", "doc": "F."}
    return wires


def _enum(name: str, members: dict[str, int]) -> Record:
    found = {label: {"value": value, "doc": "A member."} for label, value in members.items()}
    return {"class": name, "wire": "byte", "doc": "A choice.", "members": found}


def _value(name: str, items: dict[str, str]) -> Record:
    return {"class": name, "doc": "Several numbers.", "items": items}


@st.composite
def _shapes(draw: st.DrawFn) -> Record:
    """Draw bits, bytes, texts and lists; those in messages have at most 32 bytes."""
    encodings = st.sampled_from(["ascii", "utf-8", "latin-1"])
    name = {"size": draw(st.integers(2, 9)), "encoding": draw(encodings), "doc": "A text."}
    if draw(st.booleans()):
        name["padding"] = draw(st.sampled_from([0, 32, 120]))
    elements = st.sampled_from(["q0", "flag", "mode", "few"])
    return {
        "bits": {"word": draw(_bits())},
        "bytes": {
            "octets": {"size": draw(st.integers(1, 5)), "doc": "Bytes."},
            "blob": {"size": draw(_span(9)), "doc": "Some bytes."},
        },
        "texts": {
            "name": name,
            "note": {"size": draw(_span(9)), "encoding": draw(encodings), "doc": "A note."},
        },
        "lists": {
            "numbers": {"of": draw(elements), "size": draw(st.integers(1, 4)), "doc": "Numbers."},
            "pairs": {"of": "pair", "size": draw(st.integers(1, 2)), "doc": "Pairs."},
            "some": {"of": draw(elements), "size": draw(_span(4)), "doc": "Some numbers."},
            "groups": {
                "of": draw(st.sampled_from(["pair", "name"])),
                "size": draw(_span(2)),
                "doc": "Some groups.",
            },
        },
    }


def _span(most: int) -> st.SearchStrategy[list[int]]:
    return st.integers(0, most - 1).flatmap(
        lambda least: st.integers(least + 1, most).map(lambda top: [least, top])
    )


@st.composite
def _bits(draw: st.DrawFn) -> Record:
    """Draw a word with flags, numbers and an enum, with gaps between them."""
    width = draw(st.sampled_from(["byte", "double"]))
    parts: Record = {}
    low = draw(st.integers(0, 1))
    while low < (8 if width == "byte" else 16) and len(parts) < 4:
        high = draw(st.integers(low, min(low + 6, 7 if width == "byte" else 15)))
        part: Record = {"bits": [low, high] if high > low else low, "doc": "A part."}
        kind = draw(st.sampled_from(["", "enum", "signed"]))
        if kind == "enum" and high > low:
            part["enum"] = "few"
        elif kind == "signed":
            part["signed"] = True
        parts[f"p{low}"] = part
        low = high + 1 + draw(st.integers(0, 1))
    return {"class": "Word", "wire": width, "doc": "A word.", "parts": parts}


@st.composite
def quantity(draw: st.DrawFn, wires: Record) -> Record:
    """Draw a quantity on one of the wire types, with or without a range or choices."""
    name = draw(st.sampled_from(sorted(wires)))
    wire = wires[name]
    if wire.get("encoding") == "float":
        return draw(_real_quantity(name))
    top = 256 ** wire["bytes"] - 1
    signed_at = wire.get("signed_at", top)
    lowest = 0 if signed_at == top else signed_at + 1 - 256 ** wire["bytes"]
    made: Record = {"wire": name, "doc": "A quantity."}
    steps = st.integers(lowest, signed_at)
    if draw(st.integers(0, 3)) == 0:
        made["choices"] = draw(st.lists(steps, min_size=1, max_size=4, unique=True))
        return made
    scale = draw(st.sampled_from(SCALES))
    made |= {"scale": scale, "unit": draw(st.sampled_from(sorted(UNITS)))}
    if draw(st.booleans()):
        ends = sorted([draw(steps), draw(steps)])
        made["range"] = [decimal(end * Fraction(scale)) for end in ends]
    return made


@st.composite
def _real_quantity(draw: st.DrawFn, wire: str) -> Record:
    """Draw a quantity that is a float, with or without a range."""
    made: Record = {"wire": wire, "unit": draw(st.sampled_from(sorted(UNITS))), "doc": "Q."}
    kind = draw(st.integers(0, 2))
    if kind == 0:
        made["range"] = sorted([draw(st.integers(-1000, 0)), draw(st.integers(0, 1000))])
    elif kind == 1:
        made["not_finite"] = True
    return made
