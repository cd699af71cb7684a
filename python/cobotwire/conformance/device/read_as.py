"""Say what a device may read in bytes that were sent one after the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cobotwire.conformance.hex_text import shown
from cobotwire.conformance.report import Exchange
from cobotwire.protocol.table import Table


def sent_last(table: Table, sent: Sequence[Exchange]) -> str:
    """Return what was sent last, and what else a device may have read in it."""
    last = ", ".join(f"{each.note} ({shown(each.data)})" for each in sent)
    misread = unknown_ids(table, b"".join(each.data for each in sent))
    return f"sent last: {last}{misread and f'; {misread}'}"


def unknown_ids(table: Table, data: bytes) -> str:
    """Return which unknown ids the bytes hold, in words; empty if they hold none.

    A device may read an incomplete request, together with the bytes after it, as another request.
    """
    found = list(dict.fromkeys(_unknown(table, data)))
    if not found:
        return ""
    return f"read as one stream, this holds the unknown id {', '.join(found)}"


def _unknown(table: Table, data: bytes) -> Iterator[str]:
    frame, at = table.frame, 0
    lengths: dict[int, set[int]] = {}
    for command in table.commands:
        sizes = {frame.length(variant.size) for variant in command.request}
        lengths.setdefault(command.id, set()).update(sizes)
    while (at := data.find(frame.header, at)) >= 0 and len(data) - at >= frame.head_size:
        id, length = frame.read_id(data, at), frame.read_length(data, at)
        if id not in lengths:
            yield f"{id:02X} in {shown(data[at : at + frame.head_size])}"
        # The data of a whole request may hold a header.
        whole = length in lengths.get(id, ())
        at += frame.overhead + length if whole else 1
