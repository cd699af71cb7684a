"""Draw random frame formats and their statements in a spec; encode from the statement alone."""

from __future__ import annotations

import json
from functools import cache, reduce
from operator import xor
from pathlib import Path
from typing import Any

from hypothesis import strategies as st

from cobotwire.protocol.checks import ByteOrder, Check, CoveredFrom
from cobotwire.protocol.frame_format import CountedPart, FixedPart, FrameFormat, Unsigned
from cobotwire.protocol.table import Crc
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.catalogue import CRCS, WIDTHS
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition
from cobotwire_codegen.wire import remainder

LAYOUTS: st.SearchStrategy[tuple[FixedPart, ...]] = st.sampled_from(
    [
        ("address", "length", "command"),
        ("length", "address", "command"),
        ("command", "address", "length"),
        ("address", "command", "length"),
    ]
)
COUNTED: list[CountedPart] = ["header", "address", "length", "command", "check", "footer"]
# Constants, as in random_tables.
ORDERS: st.SearchStrategy[ByteOrder] = st.sampled_from(["big", "little"])
STARTS: st.SearchStrategy[CoveredFrom] = st.sampled_from(
    ["header", "address", "length", "command", "data"]
)
NAMES = st.sampled_from(sorted(WIDTHS)) | st.sampled_from(sorted(CRCS))
BYTES = st.sampled_from([0xFA, 0xFE, 0])
FOOTERS = BYTES.map(lambda value: bytes([value]))
HEADERS = st.sampled_from([b"\xfe\xfe", b"\xb5b", b"\xff\xff\xfd\0"]) | st.lists(
    BYTES, min_size=1, max_size=4
).map(bytes)
ADDRESSES = st.sampled_from([(), (), (1, 0), (0xFE,), tuple(range(254))])
WIDE = st.sampled_from([1, 1, 2])


@cache
@st.composite
def checks(draw: st.DrawFn) -> Check:
    """Draw a check of the catalogue."""
    start, order, name = draw(STARTS), draw(ORDERS), draw(NAMES)
    if name in WIDTHS:
        return Check(name, start, draw(st.sampled_from(WIDTHS[name])), order)  # type: ignore[arg-type]
    return Check("crc", start, -(-CRCS[name].width // 8), order, Crc(*CRCS[name][:-1]))


@cache
@st.composite
def frame_formats(draw: st.DrawFn) -> FrameFormat:
    """Draw any frame format; most have a header and addresses that are found in other bytes too."""
    check = draw(st.none() | checks())
    footer = draw(st.binary(max_size=2) if check else FOOTERS)
    header, layout = draw(HEADERS), draw(LAYOUTS)
    counted = [part for part in COUNTED if draw(st.booleans())]
    return FrameFormat(
        header,
        footer,
        draw(st.integers(2, 40)),
        check,
        draw(ADDRESSES),
        layout,
        (*counted, "data"),
        Unsigned(draw(WIDE), draw(ORDERS)),
        Unsigned(draw(WIDE), draw(ORDERS)),
        reply_has_id=layout[-1] != "command" or draw(st.booleans()),
    )


# What the reference of the language says about keys that are left out.
LEFT_OUT: dict[str, Any] = {
    "footer": "",
    "check": "footer",
    "check_bytes": 1,
    "check_order": "big",
    "layout": ["address", "length", "command"],
    "length_bytes": 1,
    "length_order": "big",
    "command_bytes": 1,
    "command_order": "big",
    "replies_have_command": True,
}
Record = dict[str, Any]


@st.composite
def frame_records(draw: st.DrawFn) -> Record:
    """Draw a frame format as a spec states it; some of them are not allowed."""
    found = draw(frame_formats())
    named = found.addresses if len(found.addresses) < 5 else ()
    record: Record = {
        "header": found.header.hex(" "),
        "footer": found.footer.hex(),
        "stuffing": False,
        "layout": list(found.layout),
        "length_counts": list(found.counted),
        "length_bytes": found.length_number.width,
        "length_order": found.length_number.order,
        "command_bytes": found.id_number.width,
        "command_order": found.id_number.order,
        "replies_have_command": found.reply_has_id,
        "addresses": {f"A{value}": {"value": value, "doc": "A device."} for value in named},
        "maximum_data": 200,
        "doc": "A frame.",
    }
    if found.addresses and not named:
        record["address_range"] = [found.addresses[0], found.addresses[-1]]
    if found.check:
        crc = found.check.crc and next(n for n in CRCS if CRCS[n][:-1] == found.check.crc)
        record["check"] = crc or found.check.algorithm
        record["check_order"] = found.check.order
        record["check_bytes"] = found.check.width
        if found.check.covers_from != ("header" if crc else "command"):
            record["check_from"] = found.check.covers_from
    # One byte is the default only of a sum.
    kept = "check_bytes" if record.get("check_bytes") == 1 and not draw(st.booleans()) else ""
    return {k: v for k, v in record.items() if k == kept or LEFT_OUT.get(k) != v}


_BYTES = {"name": "data", "type": "data"}


def in_format(record: Record, id: int = 1) -> Edition:
    """Return an edition whose only command sends bytes and receives bytes, in a frame format.

    Raises:
        SpecError: the language does not allow the format.
    """
    data = {"size": [2, 20], "doc": "Some bytes."}
    about = {"title": "Send", "doc": "Sends bytes.", "safety": "query"}
    spec = {
        "edition": "plain",
        "class": "Plain",
        "title": "Bytes",
        "doc": "Bytes.",
        "joints": 0,
        "frame": {"frame": record, "transport": {"baudrate": 9600, "deadline_ms": 500}},
        "types": {"wire": {"byte": {"bytes": 1, "doc": "A byte."}}, "bytes": {"data": data}},
        "commands": {"send": {"id": id, **about, "request": [_BYTES], "reply": [_BYTES]}},
    }
    path = Path("plain.yaml").resolve()
    return build_edition(path, path.parent, {path: json.dumps(spec)})


def formats() -> st.SearchStrategy[tuple[Record, Edition]]:
    """Draw a frame format that the language allows, and an edition with it."""

    def allowed(record: Record) -> tuple[Record, Edition] | None:
        try:
            return record, in_format(record)
        except SpecError:
            return None

    # A filter draws again; an assumption would end the test.
    found = frame_records().map(allowed)
    return found.filter(lambda made: made is not None)  # type: ignore[return-value]


def stated_frame(record: Record, id: int, data: bytes, address: int, *, reply: bool) -> bytes:
    """Return the frame that a spec states, without the model and the codecs."""
    given = {**LEFT_OUT, **record}
    check, size = given["check"], given["check_bytes"]
    crc = CRCS.get(check)
    if "check_bytes" not in record and check != "footer":
        size = -(-crc.width // 8) if crc else WIDTHS[check][0]
    named = given.get("addresses") or given.get("address_range")
    sent = given["replies_have_command"] or not reply
    parts = {
        "header": bytes.fromhex(given["header"]),
        "address": bytes([address]) if named else b"",
        "length": bytes(given["length_bytes"]),
        "command": id.to_bytes(given["command_bytes"], given["command_order"]) if sent else b"",
        "data": data,
        "check": bytes(0 if check == "footer" else size),
        "footer": bytes.fromhex(given["footer"]),
    }
    length = sum(len(parts[part]) for part in given["length_counts"])
    parts["length"] = length.to_bytes(given["length_bytes"], given["length_order"])
    order = ["header", *given["layout"], "data"]
    first = given.get("check_from", "header" if crc else "command")
    covered = b"".join(parts[part] for part in order[order.index(first) :])
    if check != "footer":
        number = remainder(crc, covered) if crc else _number(check, covered) % (1 << 8 * size)
        parts["check"] = number.to_bytes(size, given["check_order"])
    return b"".join(parts[part] for part in (*order, "check", "footer"))


def _number(check: str, covered: bytes) -> int:
    """Return a check that is no CRC, as the reference of the language describes it."""
    if check == "xor":
        return reduce(xor, covered, 0)
    if check in ("fletcher", "fletcher-16"):
        first = second = 0
        for byte in covered:
            first = (first + byte) % (256 if check == "fletcher" else 255)
            second = (second + first) % (256 if check == "fletcher" else 255)
        return second << 8 | first
    total = sum(covered)
    return {"sum": total, "inverted-sum": ~total, "negated-sum": -total}[check]
