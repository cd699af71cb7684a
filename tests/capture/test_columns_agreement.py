"""The native reader of captures returns what the reference returns, for any file and any pieces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from capture.foreign_files import damaged_files, files
from cobotwire import codec as codecs
from cobotwire.capture import Interface
from cobotwire.capture.captured_columns import CapturedColumns, StreamColumns
from cobotwire.capture.native_columns import NativeColumnsReader
from cobotwire.capture.reference_columns import ReferenceCaptureReader
from cobotwire.codec.interface import Codec, Listening
from cobotwire.editions import load

TABLES = {name: load(name).TABLE for name in ("mycobot280", "mycobot320")}
LISTENING: list[Listening] = ["both", "request", "reply"]


def codec_of(name: codecs.CodecName) -> Callable[[Interface], Codec]:
    known = {edition: codecs.load(table, name) for edition, table in TABLES.items()}
    return lambda interface: known.get(interface.edition, known["mycobot320"])


NATIVE, REFERENCE = codec_of("native"), codec_of("reference")


def plain(found: CapturedColumns) -> dict[str, Any]:
    """Return everything in a batch, to compare."""
    return {
        "application": found.application,
        "interfaces": found.interfaces,
        "size": found.size,
        "finished": found.finished,
        "truncated_at": found.truncated_at,
        "error": str(found.error),
        "streams": [plain_stream(stream) for stream in found.streams],
    }


def plain_stream(stream: StreamColumns) -> dict[str, Any]:
    return {
        "of": (stream.interface, stream.direction),
        "counters": stream.counters,
        "noise": [list(column) for column in stream.noise],
        "rejected": [list(column) for column in stream.rejected],
        "rows": {
            (rows.command.name, rows.message_direction, rows.variant_index): {
                "time": rows.time.tolist(),
                "offset": rows.offset.tolist(),
                "address": list(rows.address or ()),
                **{name: rows[name].tolist() for name in rows.names},
            }
            for rows in stream
        },
    }


def joined(batches: Sequence[CapturedColumns]) -> dict[str, Any]:
    """Return the last batch with the rows, noise and rejected frames of all batches."""
    last = plain(batches[-1])
    for place, stream in enumerate(last["streams"]):
        parts = [plain(batch)["streams"][place : place + 1] for batch in batches]
        earlier = [part for found in parts for part in found]
        for key in ("noise", "rejected"):
            stream[key] = [list(chain(*each)) for each in zip(*[part[key] for part in earlier])]
        rows: dict[Any, dict[str, list[Any]]] = {}
        for part in earlier:
            for variant, columns in part["rows"].items():
                for name, column in columns.items():
                    rows.setdefault(variant, {}).setdefault(name, []).extend(column)
        stream["rows"] = rows
    return last


def whole(data: bytes, listening: Listening, raw: bool) -> dict[str, Any]:
    """Return what both readers find in a file; check that it is the same."""
    native = NativeColumnsReader(NATIVE, listening, raw, "x")
    reference = ReferenceCaptureReader(REFERENCE, listening, raw, "x")
    native.add(data)
    reference.add(data)
    expected = plain(reference.finish())
    assert plain(native.finish()) == expected
    return expected


@settings(max_examples=150)
@given(files, st.sampled_from(LISTENING), st.booleans())
def test_readers_agree_about_files_of_any_program(
    data: bytes, listening: Listening, raw: bool
) -> None:
    found = whole(data, listening, raw)
    # At the wrong resolution some times are beyond 64 bits.
    assert found["error"] == "None" or "years 1678 to 2261" in found["error"]


@settings(max_examples=200)
@given(damaged_files(), st.sampled_from(LISTENING))
def test_readers_agree_about_damaged_files(data: bytes, listening: Listening) -> None:
    whole(data, listening, raw=False)


@settings(max_examples=60)
@given(st.one_of(files, damaged_files()), st.data())
def test_rows_do_not_depend_on_the_pieces_of_the_file(data: bytes, draw: st.DataObject) -> None:
    native = NativeColumnsReader(NATIVE, "both", False, "x")
    reference = ReferenceCaptureReader(REFERENCE, "both", False, "x")
    batches = []
    at = 0
    while at < len(data):
        size = draw.draw(st.sampled_from([1, 3, 8, 12, 33, 64, 200, 1000]))
        batch = native.feed(data[at : at + size])
        assert plain(batch) == plain(reference.feed(data[at : at + size]))
        batches.append(batch)
        at += size
    batches.append(native.finish())
    assert plain(batches[-1]) == plain(reference.finish())
    expected = whole(data, "both", raw=False)
    found = joined(batches)
    # After damage the rest of a piece is not read, but it was fed.
    if found["error"] != "None":
        expected["size"] = found["size"] = 0
    assert found == expected
